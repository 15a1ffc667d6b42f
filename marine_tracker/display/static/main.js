// The page: puts link, state, picture, panel and controls together.

import { seconds } from './app.js';
import * as controls from './controls.js';
import * as forms from './forms.js';
import { rangeBearing, toMap, toScreen } from './geometry.js';
import * as keys from './keys.js';
import { Link } from './link.js';
import * as panel from './panel.js';
import { draw, scopeOf, targetAt } from './picture.js';
import * as pointer from './pointer.js';
import { Sound } from './sound.js';
import { CHOICES, RANGES, keep, load } from './settings.js';
import { emptyState, receive, reconnected, staleness, unacknowledged } from './state.js';

const REDRAW_MS = 250; // at least: echoes fade, dangers flash
const PANEL_MS = 200;
const SAID_MS = 6000;
const MOST_LINES = 2;

const state = emptyState();
const settings = load(location.search);
const canvas = /** @type {HTMLCanvasElement} */ (panel.element('picture'));
const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
/** @type {import('./surround.js').Marks} */
const marks = { id: null, cursor: null, lines: [], drag: null };
const sorted = { column: 6, sign: 1, danger: true };
let courseUp = 0; // rad, when course-up was chosen
let dirty = true;
let saidUntil = 0;
let drawn = -Infinity;
let panelShown = -Infinity;

const link = new Link(
  location.hash.slice(1),
  (message) => {
    receive(state, message, seconds());
    if (message.kind === 'alarms') showTitle();
    if (message.kind === 'limits') forms.fillLimits(message);
    dirty = true;
  },
  () => reconnected(state),
);

/** @type {import('./app.js').App} */
const app = {
  state,
  settings,
  marks,
  sound: new Sound(),
  canvas,
  pointer: null,
  colors: {},
  scopeNow: () => scopeOf(state, settings, canvas.clientWidth, canvas.clientHeight, courseUp),
  redraw() {
    dirty = true;
  },
  change(name, value) {
    settings[name] = value;
    if (name === 'orientation') courseUp = state.own?.heading ?? 0;
    keep(settings);
    controls.applySettings(app);
  },
  zoom(step) {
    app.change('range', Math.min(Math.max(settings.range + step, 0), RANGES.length - 1));
  },
  async command(name, values = {}) {
    const { ok, text } = await link.send(name, values);
    app.tell(`${ok ? '' : 'Not done: '}${text.split(';')[0]}`);
    return ok;
  },
  tell(text) {
    panel.say(panel.element('said'), text);
    clearTimeout(saidUntil);
    saidUntil = setTimeout(() => panel.say(panel.element('said'), ''), SAID_MS);
  },
  chosen: () => state.targets.find((target) => target.id === marks.id),
  choose(id) {
    marks.id = id;
    panelShown = -Infinity;
    dirty = true;
  },
  selectAt(x, y) {
    const { view } = app.scopeNow();
    marks.cursor = toMap(view, x, y);
    app.choose(targetAt(state, view, x, y)?.id ?? null);
  },
  acquire() {
    if (marks.cursor) app.command('acquire', { x: marks.cursor[0], y: marks.cursor[1] });
    else app.tell('Click where to acquire first, or move the cursor there.');
  },
  cancel() {
    const target = app.chosen();
    if (target?.number) app.command('cancel', { number: target.number });
  },
  /** A bearing line with a range marker at the cursor; after two of them, none. */
  mark() {
    const place = marks.cursor ?? (app.pointer && toMap(app.scopeNow().view, ...app.pointer));
    if (marks.lines.length === MOST_LINES) marks.lines = [];
    else if (place && state.own) {
      marks.lines.push(rangeBearing(state.own.x, state.own.y, place[0], place[1]));
    }
    dirty = true;
  },
};

function frame() {
  requestAnimationFrame(frame);
  const now = performance.now();
  if (!dirty && now - drawn < REDRAW_MS) return;
  dirty = false;
  drawn = now;
  const ratio = window.devicePixelRatio || 1;
  const width = Math.round(canvas.clientWidth * ratio);
  const height = Math.round(canvas.clientHeight * ratio);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  const scope = app.scopeNow();
  draw(pen, state, settings, scope, app.colors, marks, seconds());
  panel.showCorners(state, settings, scope, marks, app.pointer);
  if (now - panelShown > PANEL_MS) {
    panelShown = now;
    showPanel();
  }
}

function showPanel() {
  const mayCommand = state.role.commands;
  panel.showOwnShip(state);
  panel.showAlarms(state, mayCommand, (number) => app.command('acknowledge', { number }));
  panel.showSelected(app.chosen());
  panel.showTargets(state.targets, sorted, marks.id, app.choose);
  panel.showState(state);
  for (const id of ['acknowledge-all', 'acquire', 'cancel', 'trial-off']) {
    /** @type {HTMLButtonElement} */ (panel.element(id)).disabled = !mayCommand;
  }
  for (const button of document.querySelectorAll('form .submit')) button.disabled = !mayCommand;
}

/** Goes on in a hidden tab: what waits for an answer stands in its title. */
function showTitle() {
  const count = unacknowledged(state).length;
  document.title = count ? `(${count}) alarm${count > 1 ? 's' : ''} - PPI` : 'PPI';
}

/** By a timer, not by messages: silence shows itself. The alarms' sound goes by it, too. */
function showStale() {
  if (settings.sound === 'on') app.sound.update(state.alarms, seconds());
  panel.element('silence').hidden = settings.sound !== 'on';
  const why = staleness(state, seconds());
  const stale = panel.element('stale');
  stale.hidden = !why;
  if (why) {
    const text = stale.firstElementChild ?? stale.appendChild(document.createElement('span'));
    panel.say(text, why);
    document.title = 'NO LIVE DATA - PPI';
  } else if (document.title.startsWith('NO')) showTitle();
}

controls.listen(app);
keys.listen(app);
pointer.listen(app);
forms.listen(app);
panel.makeHeads((column) => {
  sorted.sign = sorted.column === column ? -sorted.sign : 1;
  sorted.column = column;
  sorted.danger = column === 6;
  panelShown = -Infinity;
});

new ResizeObserver(app.redraw).observe(canvas);
controls.applySettings(app);
showStale();
setInterval(showStale, 500);
requestAnimationFrame(frame);

// For tests, and for whoever looks from the console.
window.ppi = { ...app, app, toScreen, toMap, rangeBearing, CHOICES };
