// The page: puts link, state, picture, panel and controls together.

import { actions } from './actions.js';
import { showAlerts } from './alerts.js';
import * as aisPanel from './ais_panel.js';
import { alive } from './alive.js';
import { seconds } from './app.js';
import * as controls from './controls.js';
import { showCorners } from './corners.js';
import { dangersSay, keepWatch } from './dangers.js';
import * as demo from './demo.js';
import * as forms from './forms.js';
import { rangeBearing, toMap, toScreen } from './geometry.js';
import * as keys from './keys.js';
import { Surface } from './layers.js';
import { Link } from './link.js';
import * as panel from './panel.js';
import { Pace } from './pace.js';
import { draw, targetAt } from './picture.js';
import * as pointer from './pointer.js';
import { keepInSight, newHeld, scopeOf } from './scope.js';
import { Sound } from './sound.js';
import { CHOICES, RANGES, keep, kept, load } from './settings.js';
import { ACTIVATED, selection, shipsShown } from './ships.js';
import { emptyState, receive, reconnected } from './state.js';
import { makeHeads, showTargets } from './table.js';
import { newTools, restoreLines } from './tools.js';
import * as toolsPanel from './tools_panel.js';
import { showTrial } from './trial.js';
import * as zonesPanel from './zones_panel.js';

const PANEL_MS = 200;
const ALIVE_MS = 100;
const SAID_MS = 6000;

const state = emptyState();
const settings = load(location.search);
const canvas = /** @type {HTMLCanvasElement} */ (panel.element('picture'));
const surface = new Surface(canvas);
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
restoreLines(marks.tools, kept('lines'));
const held = newHeld();
const pace = new Pace();
let saidUntil = 0;
let frames = 0; // drawn so far
let panelShown = -Infinity;

const link = new Link(
  location.hash.slice(1),
  (message) => {
    receive(state, message, seconds());
    // In a hidden tab timers hardly run: alarms go on by what comes each second.
    if (message.kind === 'alarms' || message.kind === 'pulse') showAlive();
    if (message.kind === 'limits') forms.fillLimits(message);
    if (message.kind === 'ais') aisPanel.fillSettings(message);
    pace.news();
  },
  () => reconnected(state),
  () => state.late,
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
  redraw: () => pace.ask(),
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
  chosen: () => selection(state, marks.id),
  choose(id) {
    marks.id = id;
    panelShown = -Infinity;
    pace.ask();
  },
  selectAt(x, y) {
    const { view } = app.scopeNow();
    marks.cursor = toMap(view, x, y);
    const { asking } = app;
    if (asking) {
      app.stopAsking();
      asking(marks.cursor);
    } else app.choose(targetAt(state, settings, view, x, y)?.id ?? null);
  },
  acquire() {
    if (marks.cursor) app.command('acquire', { x: marks.cursor[0], y: marks.cursor[1] });
    else app.tell('Click where to acquire first, or move the cursor there.');
  },
  cancel() {
    const { target } = app.chosen();
    if (target?.number) app.command('cancel', { number: target.number });
  },
  /** For all viewers, by whoever may command; else on this device. */
  silence() {
    if (state.role.commands) app.command('silence');
    else app.sound.silence(seconds());
  },
};
Object.assign(app, actions(app));

function frame() {
  requestAnimationFrame(frame);
  const now = performance.now();
  if (!pace.due(now)) return;
  frames++;
  const pen = surface.ready();
  const scope = app.scopeNow();
  draw(pen, state, settings, scope, app.colors, marks, seconds());
  const more = dangersSay(state, settings, seconds());
  showCorners(state, settings, scope, marks, app.pointer, more, seconds());
  if (now - panelShown > PANEL_MS) {
    panelShown = now;
    showPanel();
  }
}

function showPanel() {
  const mayCommand = state.role.commands;
  panel.showOwnShip(state);
  showAlerts(app);
  const chosen = app.chosen();
  panel.showSelected(chosen, state);
  aisPanel.showAis(app, chosen.ship);
  const activated = shipsShown(state, settings).filter((ship) => ship.shown === ACTIVATED);
  showTargets([...state.targets, ...activated], sorted, chosen.id, app.choose);
  panel.showState(state);
  showTrial(state, seconds());
  toolsPanel.show();
  zonesPanel.show(app);
  demo.showDemo(state);
  for (const id of ['acknowledge-all', 'acquire', 'cancel', 'trial-off']) {
    /** @type {HTMLButtonElement} */ (panel.element(id)).disabled = !mayCommand;
  }
  for (const button of document.querySelectorAll('form .submit')) button.disabled = !mayCommand;
}

const showAlive = () => {
  alive(app, surface, seconds());
  keepWatch(settings, link);
};

controls.listen(app);
keys.listen(app);
pointer.listen(app);
forms.listen(app);
aisPanel.listen(app);
toolsPanel.listen(app);
zonesPanel.listen(app);
demo.listen(app);
makeHeads((column) => {
  sorted.sign = sorted.column === column ? -sorted.sign : 1;
  sorted.column = column;
  sorted.danger = column === 6;
  panelShown = -Infinity;
});

new ResizeObserver(app.redraw).observe(canvas);
controls.applySettings(app);
showAlive();
setInterval(showAlive, ALIVE_MS);
canvas.addEventListener('contextlost', () => {
  showAlive();
  app.redraw();
});
requestAnimationFrame(frame);

// For tests, and for whoever looks from the console.
window.ppi = { ...app, app, surface, frames: () => frames, toScreen, toMap, rangeBearing, CHOICES };
