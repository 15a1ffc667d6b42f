// The page: puts link, state, picture, panel and controls together.

import { actions } from './actions.js';
import { seconds } from './app.js';
import * as controls from './controls.js';
import { showCorners } from './corners.js';
import * as forms from './forms.js';
import { rangeBearing, toMap, toScreen } from './geometry.js';
import * as keys from './keys.js';
import { Link } from './link.js';
import * as panel from './panel.js';
import { draw, targetAt } from './picture.js';
import * as pointer from './pointer.js';
import { keepInSight, newHeld, scopeOf } from './scope.js';
import { Sound } from './sound.js';
import { CHOICES, RANGES, keep, load } from './settings.js';
import { newTools } from './tools.js';
import * as toolsPanel from './tools_panel.js';
import * as zonesPanel from './zones_panel.js';
import { emptyState, receive, reconnected, staleness, unacknowledged } from './state.js';

const REDRAW_MS = 250; // at least: echoes fade, dangers flash
const PANEL_MS = 200;
const SAID_MS = 6000;

const state = emptyState();
const settings = load(location.search);
const canvas = /** @type {HTMLCanvasElement} */ (panel.element('picture'));
const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
/** @type {import('./surround.js').Marks} */
const marks = {
  id: null,
  cursor: null,
  drag: null,
  tools: newTools(),
  draft: null,
  asked: null,
  hidden: { heading: -Infinity, graphics: -Infinity },
};
const sorted = { column: 6, sign: 1, danger: true };
const held = newHeld();
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

/** @type {any} */
const app = {
  state,
  settings,
  marks,
  sound: new Sound(),
  canvas,
  pointer: null,
  colors: {},
  held,
  asking: null,
  scopeNow() {
    keepInSight(held, state, settings);
    return scopeOf(state, settings, canvas.clientWidth, canvas.clientHeight, held);
  },
  redraw() {
    dirty = true;
  },
  change(name, value) {
    app.choices({ [name]: value });
    if (name === 'orientation') held.courseUp = state.own?.heading ?? 0;
  },
  choices(some) {
    Object.assign(settings, some);
    keep(settings);
    controls.applySettings(app);
  },
  zoom(step) {
    app.change('range', Math.min(Math.max(settings.range + step, 0), RANGES.length - 1));
  },
  async command(name, values = {}) {
    const answer = await link.send(name, values);
    app.tell(`${answer.ok ? '' : 'Not done: '}${answer.text.split(/[;\n]/)[0]}`);
    return answer;
  },
  tell(text, ms = SAID_MS) {
    panel.say(panel.element('said'), text);
    clearTimeout(saidUntil);
    if (ms < Infinity) saidUntil = setTimeout(() => app.tell('', Infinity), ms);
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
    const { asking } = app;
    if (asking) {
      app.stopAsking();
      asking(marks.cursor);
    } else app.choose(targetAt(state, view, x, y)?.id ?? null);
  },
  acquire() {
    if (marks.cursor) app.command('acquire', { x: marks.cursor[0], y: marks.cursor[1] });
    else app.tell('Click where to acquire first, or move the cursor there.');
  },
  cancel() {
    const target = app.chosen();
    if (target?.number) app.command('cancel', { number: target.number });
  },
};
Object.assign(app, actions(app));

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
  showCorners(state, settings, scope, marks, app.pointer);
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
  toolsPanel.show();
  zonesPanel.show(app);
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
toolsPanel.listen(app);
zonesPanel.listen(app);
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
