// Ships of AIS: triangles by SN.1/Circ.243, of those that radar does not see, or sees elsewhere.

import { toScreen, turned } from './geometry.js';
import * as symbols from './symbols.js';

const FLASH_S = 0.5;
const SLEEPING = 1; // of `shown`
const [AID, SART] = [3, 4]; // of `kind`
const [JOINED, MISMATCH] = [2, 3]; // of `state`
const DANGEROUS = 2;
const TURNING = 0.003; // rad/s; a slower turn has no flag

/** @typedef {Record<string, any>} Ship  one row of `ais/targets` */

/** Which way her triangle points: heading, else course, else up. @param {Ship} ship */
export function direction(ship, up = 0) {
  return ship.heading ?? ship.course ?? up;
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
 * @param {CanvasRenderingContext2D} canvas
 * @param {import('./state.js').State} state @param {import('./settings.js').Settings} settings
 * @param {import('./scope.js').Scope} scope @param {Record<string, string>} colors
 * @param {number} local s
 * @returns {import('./labels.js').Label[]} what is to be written beside them
 */
export function drawShips(canvas, state, settings, scope, colors, local) {
  const { view } = scope;
  const off = Math.floor(local / FLASH_S) % 2 === 1;
  /** @type {import('./labels.js').Label[]} */
  const labels = [];
  for (const ship of state.ships) {
    if (ship.state === JOINED || ship.x === null) continue;
    const [x, y] = toScreen(view, ship.x, ship.y);
    const told = alarmOf(state.alarms, ship.lost ? 'AIS lost' : 'AIS danger', ship.mmsi);
    if (off && told.endsWith('unacknowledged')) continue;
    const danger = ship.danger === DANGEROUS;
    const color = danger || ship.lost ? colors.danger : colors.target;
    if (ship.kind === SART) symbols.beacon(canvas, x, y, colors.danger);
    else if (ship.kind === AID) symbols.aid(canvas, x, y, color);
    else drawShip(canvas, ship, settings, state.own, view, x, y, color, danger);
    const mismatch = ship.state === MISMATCH;
    if (mismatch || (ship.shown !== SLEEPING && settings.labels === 'on')) {
      const name = ship.name || String(ship.mmsi);
      labels.push({ x, y, text: mismatch ? `${name} ?` : name, needed: mismatch || danger });
    }
  }
  return labels;
}

function drawShip(canvas, ship, settings, own, view, x, y, color, danger) {
  const angle = direction(ship, view.up) - view.up;
  const sleeping = ship.shown === SLEEPING && !danger;
  const unknown = !sleeping && ship.cpa === null;
  symbols.triangle(canvas, x, y, angle, color, { sleeping, bold: danger, broken: unknown });
  if (ship.lost) symbols.across(canvas, x, y, color);
  if (sleeping || ship.lost) return;
  if (ship.vx !== null && ship.vy !== null && settings.vectors !== 'relative') {
    const seconds = 60 * settings.vectorMinutes;
    const [right, down] = turned(view, ship.vx * seconds, ship.vy * seconds);
    symbols.vector(canvas, x, y, right, down, color, danger);
  }
  if (ship.heading !== null) symbols.headingLine(canvas, x, y, angle, color, flagOf(ship));
}

/** 1 to starboard, -1 to port, 0 where she does not turn or does not tell. @param {Ship} ship */
export function flagOf(ship) {
  return Math.abs(ship.turn ?? 0) < TURNING ? 0 : Math.sign(ship.turn);
}
