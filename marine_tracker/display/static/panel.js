// What stands beside the picture: own ship, alarms, the selected target, the table, the state.

import * as format from './format.js';
import { rangeBearing } from './geometry.js';
import { bowOf } from './scope.js';
import { headOf, passingOf, wordsOf } from './ship_words.js';
import { COASTING, LOST, ACQUIRING, nameOf } from './state.js';

const STATUS = {
  [ACQUIRING]: 'acquiring',
  1: 'tracking',
  [COASTING]: 'coasting',
  [LOST]: 'lost',
};
const MOTION = ['steady', 'manoeuvring', 'at rest'];
export const STABILISED = {
  ground: 'courses over ground',
  sea: 'courses through the water',
  none: 'COURSES NOT KNOWN',
};
const CLOCK_S = 30; // a larger difference of the time of day is told
/** @param {string} id @returns {HTMLElement} */
export const element = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

/** Set a text only where it differs: what does not change is not laid out again. */
export function say(/** @type {Element} */ where, /** @type {string} */ text) {
  if (where.textContent !== text) where.textContent = text;
}

/** Terms and figures as the children of a <dl>; a figure may have its deviation. */
function fill(/** @type {HTMLElement} */ list, /** @type {string[][]} */ figures) {
  while (list.children.length > 2 * figures.length) list.lastChild?.remove();
  figures.forEach(([term, value, deviation], row) => {
    if (list.children.length <= 2 * row) {
      const dd = document.createElement('dd');
      dd.append(document.createElement('span'), ' ', document.createElement('small'));
      list.append(document.createElement('dt'), dd);
    }
    say(list.children[2 * row], term);
    const [main, small] = list.children[2 * row + 1].children;
    say(main, value.startsWith(format.NONE) ? format.NONE : value); // no unit of nothing
    const known = deviation && deviation !== format.NONE && !value.startsWith(format.NONE);
    say(small, known ? `±${deviation}` : '');
  });
}

export function showOwnShip(/** @type {import('./state.js').State} */ state) {
  const own = state.own;
  const speed = own ? Math.hypot(own.vx, own.vy) : null;
  const course = own && speed ? Math.atan2(own.vx, own.vy) : null;
  fill(element('own'), [
    ['HDG', `${format.bearing(own?.heading)}°`],
    ['COG', `${format.bearing(course)}°`],
    ['SOG', `${format.knots(speed)} kn`],
    ['POS', own ? format.place(own.latitude, own.longitude) : format.NONE],
  ]);
}

/**
 * The data of the selected target, each with its standard deviation; of a ship of AIS what she tells,
 * first of all unless radar goes first.
 * @param {ReturnType<typeof import('./ships.js').selection>} chosen
 * @param {import('./state.js').State} state
 */
export function showSelected({ target, ship }, { own, ais }) {
  element('data').classList.toggle('radar-first', ais?.ais_symbol === 'radar');
  say(element('selected-name'), target ? headOfTarget(target, ship) : ship ? headOf(ship) : NOBODY);
  fill(element('selected-ship'), ship ? wordsOf(ship, own) : []);
  fill(element('selected'), target ? figuresOf(target, own) : ship ? passingOf(ship) : []);
}

const NOBODY = 'No target selected';

function headOfTarget(target, ship) {
  const source = ship ? ', radar and AIS' : '';
  return `${nameOf(target)}, ${STATUS[target.status]}, ${MOTION[target.motion]}${source}`;
}

function figuresOf(/** @type {import('./state.js').Target} */ target, own) {
  const figures = [
    ['Range', `${format.miles(target.range)} NM`, format.miles(target.range_sd, 3)],
    ['Bearing', `${format.bearing(target.bearing)}°`, angleSd(target.bearing_sd)],
    ['Rel. brg', `${format.bearing(relativeBearing(target, own))}°`],
    ['Course', `${format.bearing(target.course)}°`, angleSd(target.course_sd)],
    ['Speed', `${format.knots(target.speed)} kn`, format.knots(target.speed_sd)],
    ['CPA', `${format.miles(target.cpa)} NM`, format.miles(target.cpa_sd)],
    ['TCPA', `${format.minutes(target.tcpa)} min`, format.minutes(target.tcpa_sd)],
    ['Bow', `${format.miles(target.bow_range)} NM`, format.miles(target.bow_range_sd)],
    ['Bow in', `${format.minutes(target.bow_time)} min`, format.minutes(target.bow_time_sd)],
    ['P(danger)', `${format.number(100 * target.danger_probability, 0)} %`],
    ['Acquired', target.acquired ? 'by hand' : 'automatic'],
  ];
  if (target.length !== null) {
    figures.push(
      ['Length', `${format.number(target.length, 0)} m`, format.number(target.length_sd, 0)],
      ['Heading', `${format.bearing(target.heading)}°`, angleSd(target.heading_sd)],
    );
  }
  return figures;
}

/** From the bow, or from where it was when the heading was lost; null where nobody knows. */
function relativeBearing(target, own) {
  if (!own || target.x === null || (own.heading === null && own.bow == null)) return null;
  return rangeBearing(own.x, own.y, target.x, target.y)[1] - bowOf(own);
}

function angleSd(/** @type {number|null} */ sd) {
  return format.number(sd === null ? null : (sd * 180) / Math.PI, 1);
}

/** Health, limits, trial, and what this viewer may do. */
export function showState(state) {
  const parts = Object.entries(state.health).filter(([, part]) => part.level !== 'ok');
  const estimator = Object.values(state.health).find((part) => part.estimator)?.estimator ?? '';
  say(
    element('health-is'),
    `${parts.length ? `${parts.length} to look at` : 'all well'}${estimator && `, estimator ${estimator}`}`,
  );
  const lines = Object.entries(state.health).map(
    ([name, part]) => `${part.level}: ${name}: ${part.text}`,
  );
  const list = element('health');
  while (list.children.length > lines.length) list.lastChild?.remove();
  lines.forEach((line, k) =>
    say(list.children[k] ?? list.appendChild(document.createElement('li')), line),
  );
  const limits = state.limits;
  say(
    element('limits-are'),
    limits ? `CPA ${limits.cpa_limit_nm} NM in ${limits.tcpa_limit_min} min` : format.NONE,
  );
  const off = Math.abs(state.clockError) > CLOCK_S;
  const clock = off
    ? `This device's clock is ${Math.round(state.clockError)} s off; ages do not depend on it. `
    : '';
  say(element('role'), clock + (state.role.commands ? '' : state.role.why || 'Looking only.'));
}
