// The trial manoeuvre beside the picture: what is tried, its countdown, what each target would do.

import * as format from './format.js';
import { element, say } from './panel.js';
import { numberOf } from './ships.js';
import { serverNow } from './state.js';

/** A minute and seconds as 2:05. @param {number} seconds */
const clock = (seconds) =>
  `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, '0')}`;

/**
 * Seconds until own ship begins to turn; 0 once she would have.
 * @param {import('./state.js').State} state @param {number} local s
 */
export function countdown(state, local) {
  const { trial } = state;
  if (!trial.on || !trial.countdown_min) return 0;
  const since = trial.at === undefined ? 0 : Math.max(serverNow(state, local) - trial.at, 0);
  return Math.max(60 * trial.countdown_min - since, 0);
}

/** What is tried, in words, and the table of all targets. */
export function showTrial(
  /** @type {import('./state.js').State} */ state,
  /** @type {number} */ local,
) {
  const { trial } = state;
  const table = element('trial-targets');
  table.hidden = !trial.on || !trial.safe_deg;
  say(element('trial-says'), words(state, local));
  if (table.hidden) return;
  const now = new Map([...state.targets, ...state.ships].map((one) => [name(one), one]));
  const order = (t) =>
    (t.danger ? 0 : 1e9) + (t.tcpa_min !== null && t.tcpa_min >= 0 ? t.tcpa_min : 1e6);
  const targets = [...trial.targets].sort((a, b) => order(a) - order(b));
  const body = /** @type {HTMLElement} */ (table.querySelector('tbody'));
  while (body.children.length > targets.length) body.lastChild?.remove();
  targets.forEach((target, place) => {
    const row = body.children[place] ?? body.appendChild(newRow());
    row.className = target.danger ? 'danger' : '';
    const present = now.get(target.name);
    [
      `${target.name}${target.danger ? ' !' : ''}`,
      format.miles(present?.cpa),
      format.minutes(present?.tcpa),
      format.number(target.cpa_nm, 2),
      format.number(target.tcpa_min, 1),
    ].forEach((text, column) => say(row.children[column], text));
  });
}

const name = (target) =>
  target.id < 0
    ? `AIS ${numberOf(target)}`
    : target.number
      ? `TT${String(target.number).padStart(2, '0')}`
      : `Q${target.id}`;

function newRow() {
  const row = document.createElement('tr');
  for (let k = 0; k < 5; k++) row.append(document.createElement('td'));
  return row;
}

function words(state, local) {
  const { trial } = state;
  if (!trial.on) return '';
  if (!trial.safe_deg) return trial.text;
  const safe = trial.safe_deg.map(
    ([a, b]) => `${String(a).padStart(3, '0')}–${String(b).padStart(3, '0')}`,
  );
  const left = countdown(state, local);
  const dangers = trial.targets.filter((target) => target.danger).length;
  return (
    `TRIAL ${format.number(trial.course_deg, 0).padStart(3, '0')}°, ${format.number(trial.speed_kn, 1)} kn, ` +
    `${left > 0 ? `begins in ${clock(left)}` : 'has begun'}. ` +
    `Safe courses: ${safe.join(', ') || 'none'}. ` +
    `${dangers ? `Dangerous: ${dangers}.` : 'No target is dangerous.'}`
  );
}
