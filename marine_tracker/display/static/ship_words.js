// What a ship of AIS tells of herself, and the tracker's settings of AIS, in words.

import * as format from './format.js';
import { placeAt } from './geodesic.js';
import { degrees, rangeBearing } from './geometry.js';
import { ACTIVATED, JOINED, MISMATCH, ONLY, numberOf } from './ships.js';

export const MISSING = 'missing'; // of what she does not tell
const MOST_CPA = 200; // NM: no filter

/** The same words for what is not known, with its unit for what is. */
const told = (/** @type {string} */ value, unit = '') =>
  value === format.NONE || !value ? MISSING : `${value}${unit}`;

/**
 * What she tells of herself: terms and words.
 * @param {import('./ships.js').Ship} ship @param {Record<string, any>|null} own
 */
export function wordsOf(ship, own) {
  const speed = ship.vx === null ? null : Math.hypot(ship.vx, ship.vy);
  const course = speed ? Math.atan2(ship.vx, ship.vy) : null;
  const size =
    ship.length === null ? format.NONE : `${ship.length} × ${format.number(ship.beam, 0)} m`;
  const turn = ship.turn === null ? null : 60 * degrees(ship.turn);
  return [
    ['Name', told(ship.name)],
    ['MMSI', `${numberOf(ship)}${ship.double ? ', TWO SHIPS' : ''}`],
    ['Call sign', told(ship.call_sign)],
    ['Kind', ship.what],
    ['Status', ship.nav ?? MISSING],
    ['Position', told(placeOf(ship, own))],
    ['Accuracy', ship.coarse ? 'long range, 0.1′' : ship.accurate ? 'high' : 'low'],
    ['COG, SOG', `${told(format.bearing(course), '°')}, ${told(format.knots(speed), ' kn')}`],
    ['HDG, ROT', `${told(format.bearing(ship.heading), '°')}, ${told(signed(turn), '°/min')}`],
    ['Size', told(size)],
    ['Report', `${ship.lost ? 'LOST, ' : ''}${told(format.number(ship.age, 0), ' s old')}`],
    ['Radar', joinedSays(ship)],
  ];
}

const signed = (/** @type {number|null} */ turn) =>
  turn !== null && turn > 0 ? `+${format.number(turn, 0)}` : format.number(turn, 0);

function placeOf(ship, own) {
  if (!own || own.latitude === null || ship.x === null) return format.NONE;
  const [range, bearing] = rangeBearing(own.x, own.y, ship.x, ship.y);
  const place = placeAt(own.latitude, own.longitude, range, bearing);
  return place ? format.place(...place) : format.NONE;
}

/** Which radar target she is, and how sure that is. @param {import('./ships.js').Ship} ship */
export function joinedSays(ship) {
  if (ship.state === MISMATCH) return 'MISMATCH: radar sees her elsewhere';
  const sure = `${format.number(100 * ship.probability, 0)} %`;
  if (ship.state === JOINED) return `joined, ${sure}`;
  return ship.state === ONLY && ship.probability >= 0.01
    ? `not joined; likely at ${sure}`
    : 'not joined';
}

/** What else is known of a ship that is no radar target: how she passes own ship. */
export function passingOf(/** @type {import('./ships.js').Ship} */ ship) {
  return [
    ['Range', `${format.miles(ship.range)} NM`],
    ['Bearing', `${format.bearing(ship.bearing)}°`],
    ['CPA', `${format.miles(ship.cpa)} NM`, format.miles(ship.cpa_sd)],
    ['TCPA', `${format.minutes(ship.tcpa)} min`, format.minutes(ship.tcpa_sd)],
    ['P(danger)', `${format.number(100 * ship.danger_probability, 0)} %`],
    ['Speed', `${format.knots(ship.speed)} kn`],
  ];
}

/** "AIS SKAGEN, activated": a ship alone. @param {import('./ships.js').Ship} ship */
export function headOf(ship) {
  const state = ship.lost ? 'lost' : ship.shown === ACTIVATED ? 'activated' : 'sleeping';
  return `AIS ${ship.name || numberOf(ship)}, ${state}`;
}

/** All that decides which ships show and what of them is an alarm, in words. */
export function settingsSay(
  /** @type {import('./state.js').State} */ state,
  /** @type {import('./settings.js').Settings} */ settings,
) {
  const { ais } = state;
  if (!ais) return format.NONE;
  const beyond = [`${ais.ais_range_nm} NM`];
  if (ais.ais_cpa_nm < MOST_CPA) beyond.push(`CPA ${ais.ais_cpa_nm} NM`);
  return [
    { all: 'on', activated: 'activated only', off: 'OFF' }[settings.ships],
    `sleeping to ${beyond.join(' and ')}, of ${ais.ais_kinds || 'no kind'}`,
    `activated by ${activation(ais)}`,
    `CPA alarm of ${ais.ais_sleeping_danger ? 'all' : 'activated'}`,
    ais.ais_lost_alarm ? `lost alarm to ${ais.ais_lost_range_nm} NM` : 'LOST ALARM OFF',
    ais.ais_join ? `joined shown as ${ais.ais_symbol === 'ais' ? 'AIS' : 'radar'}` : 'NOT JOINED',
  ].join('; ');
}

const activation = (ais) =>
  ais.ais_activation.replace('range', `range ${ais.ais_activation_range_nm} NM`) || 'hand only';
