// The table of targets: of however many only the rows that can be seen are made.

import * as format from './format.js';
import { element, say } from './panel.js';
import { shipName } from './ships.js';
import { LOST, nameOf } from './state.js';

/** @typedef {import('./state.js').Target} Target */

const NEVER = 1e12; // sorts behind all numbers
const BEYOND = 10; // rows made above and below those that can be seen
const ROW_PX = 33; // until one is measured
/** TT07, or the name of a ship of AIS that is no radar target. @param {Target} target */
function labelOf(target) {
  return target.id < 0 ? shipName(target) : nameOf(target);
}

/** Columns of the table: head, what a cell shows, what it is sorted by. */
/** @type {[string, (t: Target) => string, (t: Target) => number|null][]} */
export const COLUMNS = [
  ['No', labelOf, (t) => t.number || NEVER + Math.abs(t.id)],
  ['NM', (t) => format.miles(t.range), (t) => t.range],
  ['Brg°', (t) => format.bearing(t.bearing), (t) => t.bearing],
  ['Crs°', (t) => format.bearing(t.course), (t) => t.course],
  ['kn', (t) => format.knots(t.speed), (t) => t.speed],
  ['CPA', (t) => format.miles(t.cpa), (t) => t.cpa],
  ['TCPA', (t) => format.minutes(t.tcpa), (t) => (t.tcpa !== null && t.tcpa < 0 ? NEVER : t.tcpa)],
];

/** The heads of the table; sort(column) is called by a click. */
export function makeHeads(/** @type {(column: number) => void} */ sort) {
  const row = part('thead tr');
  COLUMNS.forEach(([head], column) => {
    const cell = document.createElement('th');
    const button = document.createElement('button');
    button.textContent = head;
    button.title = `Sort by ${head}`;
    button.onclick = () => sort(column);
    cell.append(button);
    row.append(cell);
  });
}

/** @type {Map<number, HTMLTableRowElement>} of the targets that can be seen, by the track's id */
const rows = new Map();
let rowPx = 0;

/**
 * The table, sorted; dangerous ones first where it is sorted by TCPA.
 * @param {Target[]} targets
 * @param {{column: number, sign: number, danger: boolean}} sorted
 * @param {number|null} chosen  id
 * @param {(id: number) => void} choose
 */
export function showTargets(targets, sorted, chosen, choose) {
  const body = part('tbody');
  const [, , key] = COLUMNS[sorted.column];
  const order = (/** @type {Target} */ t) => key(t) ?? NEVER;
  const inOrder = targets
    .filter((t) => t.status !== LOST)
    .sort((a, b) => (sorted.danger ? b.alarm - a.alarm : 0) || sorted.sign * (order(a) - order(b)));
  say(element('count'), String(inOrder.length));
  const height = rowPx || ROW_PX;
  const top = body.getBoundingClientRect().top;
  const first = Math.min(Math.max(Math.floor(-top / height) - BEYOND, 0), inOrder.length);
  const last = Math.ceil((window.innerHeight - top) / height) + BEYOND;
  const seen = inOrder.slice(first, Math.max(last, first));
  const ids = new Set(seen.map((t) => t.id));
  for (const [id, row] of rows) if (!ids.has(id)) rows.delete(id) && row.remove();
  leaveRoom(part('thead'), first * height);
  leaveRoom(part('tfoot'), (inOrder.length - first - seen.length) * height);
  seen.forEach((target, place) => {
    let row = rows.get(target.id);
    if (!row) {
      row = newRow();
      rows.set(target.id, row);
    }
    const looks = `${target.alarm ? 'danger' : ''} ${target.id === chosen ? 'chosen' : ''}`;
    if (row.className !== looks) row.className = looks;
    row.onclick = () => choose(target.id);
    COLUMNS.forEach(([, show], column) => {
      const cell = /** @type {Element} */ (row.children[column]);
      say(column ? cell : /** @type {Element} */ (cell.firstChild), show(target));
    });
    if (body.children[place] !== row) body.insertBefore(row, body.children[place] ?? null);
  });
  rowPx = rows.values().next().value?.offsetHeight || rowPx;
}

const part = (/** @type {string} */ name) =>
  /** @type {HTMLElement} */ (element('targets').querySelector(name));

/** For the rows that are not made. */
function leaveRoom(/** @type {HTMLElement} */ within, /** @type {number} */ height) {
  let row = /** @type {HTMLElement|null} */ (within.querySelector('.room'));
  if (!row) {
    row = document.createElement('tr');
    row.className = 'room';
    row.ariaHidden = 'true';
    within.append(row);
  }
  row.hidden = height <= 0;
  row.style.height = `${height}px`;
}

function newRow() {
  const row = document.createElement('tr');
  COLUMNS.forEach((_, column) => {
    const cell = document.createElement('td');
    if (!column) cell.append(document.createElement('button'));
    row.append(cell);
  });
  return row;
}
