// Ships of AIS as the page knows them: rows, which of them show, which one is selected.

export const [ACTIVATED, SLEEPING] = [0, 1]; // of `shown`
export const [ONLY, JOINED, MISMATCH] = [0, 2, 3]; // of `state`; 0 and 1 alike are no radar target
export const [AID, SART] = [3, 4]; // of `kind`
const DANGEROUS = 2;

/** @typedef {Record<string, any>} Ship  one row of `ais/targets`; id: below 0, no track has it */

/** What the page adds to the rows of a message: words, an id beside those of tracks, a velocity. */
export function readShips(/** @type {Ship[]} */ rows, /** @type {Record<string, any>} */ message) {
  for (const ship of rows) {
    ship.id = -(ship.id ?? ship.mmsi);
    ship.nav = message.statuses?.[ship.nav] ?? null;
    ship.what = message.kinds?.[ship.kind] ?? '';
    ship.alarm = ship.danger === DANGEROUS ? 1 : 0;
    // As the targets' vectors: over ground or through the water. At rest there is no course.
    const moves = ship.course !== null && ship.speed > 0;
    ship.wx = ship.speed === null ? null : moves ? ship.speed * Math.sin(ship.course) : 0;
    ship.wy = ship.speed === null ? null : moves ? ship.speed * Math.cos(ship.course) : 0;
  }
  return rows;
}

/** The ships that are joined, by the id of their track. @param {Ship[]} ships */
export function byTrack(ships) {
  const joined = ships.filter((ship) => ship.state === JOINED && ship.track);
  return new Map(joined.map((ship) => [ship.track, ship]));
}

/** How an alert of her stands: '' where there is none. @param {Record<string, any>[]} alarms */
export function alarmOf(alarms, kind, mmsi) {
  return alarms.find((alarm) => alarm.kind === kind && alarm.mmsi === mmsi)?.state ?? '';
}

/**
 * The ships that have a symbol of their own. Whoever is dangerous or lies is never left out. A lost
 * one stays until that is acknowledged; one that was asleep just goes.
 * @param {import('./state.js').State} state @param {import('./settings.js').Settings} settings
 */
export function shipsShown(state, settings) {
  const asked = { all: SLEEPING, activated: ACTIVATED, off: -1 }[settings.ships] ?? SLEEPING;
  return state.ships.filter((ship) => {
    if (ship.state === JOINED || ship.x === null) return false;
    if (ship.lost) {
      const told = alarmOf(state.alarms, 'AIS lost', ship.mmsi);
      return ship.shown === ACTIVATED && told !== 'active acknowledged';
    }
    return ship.shown <= asked || ship.alarm || ship.kind === SART || ship.state === MISMATCH;
  });
}

/**
 * The selected target and the ship that is joined to it, or the ship alone.
 * @param {import('./state.js').State} state @param {number|null} id  of a track, or of a ship
 * @returns {{id: number|null, target?: import('./state.js').Target, ship?: Ship}}
 */
export function selection(state, id) {
  if (id === null) return { id };
  if (id > 0) {
    const target = state.targets.find((one) => one.id === id);
    return { id, target, ship: target && byTrack(state.ships).get(id) };
  }
  const ship = state.ships.find((one) => one.id === id);
  const joined = ship?.state === JOINED;
  const target = joined ? state.targets.find((one) => one.id === ship.track) : undefined;
  return { id: target?.id ?? id, target, ship };
}

/** Her name, or else her number. @param {Ship} ship */
export const shipName = (ship) => ship.name || numberOf(ship);

/** MMSI, with all its digits. @param {Ship} ship */
export const numberOf = (ship) => String(ship.mmsi).padStart(9, '0');
