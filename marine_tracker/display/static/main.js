// The page: puts link, state, picture, panel and controls together.

import { alive } from './alive.js';
import * as forms from './forms.js';
import { rangeBearing, toMap, toScreen } from './geometry.js';
import { Surface } from './layers.js';
import { Link } from './link.js';
import * as panel from './panel.js';
import { makeHeads, showTargets } from './table.js';
import { draw, scopeOf, targetAt } from './picture.js';
import { Sound } from './sound.js';
import { CHOICES, RANGES, keep, load, next } from './settings.js';
import { emptyState, receive, reconnected } from './state.js';

const REDRAW_MS = 250; // at least: echoes fade, dangers flash
const PANEL_MS = 200;
const ALIVE_MS = 100;
const MOST_LINES = 2;
const STEP_PX = 8; // of the cursor by a key

const state = emptyState();
const settings = load(location.search);
const canvas = /** @type {HTMLCanvasElement} */ (panel.element('picture'));
const surface = new Surface(canvas);
/** @type {import('./surround.js').Marks} */
const marks = { id: null, cursor: null, lines: [], drag: null };
const sound = new Sound();
const sorted = { column: 6, sign: 1, danger: true };
/** @type {[number, number]|null} */
let pointer = null; // px, while the mouse is over the picture
let courseUp = 0; // rad, when course-up was chosen
let dragged = false; // own ship's vector, by the last press of the mouse
let dirty = true;
let saidUntil = 0;
let frames = 0; // drawn so far
let drawn = -Infinity;
let panelShown = -Infinity;
/** @type {Record<string, string>} */
let colors = {};

const seconds = () => performance.now() / 1000;
const link = new Link(
  location.hash.slice(1),
  (message) => {
    receive(state, message, seconds());
    // In a hidden tab timers hardly run: alarms go on by what comes each second.
    if (message.kind === 'alarms' || message.kind === 'pulse') showAlive();
    if (message.kind === 'limits') forms.fillLimits(message);
    dirty = true;
  },
  () => reconnected(state),
  () => state.late,
);

// -- out -------------------------------------------------------------------------------------

function scopeNow() {
  return scopeOf(state, settings, canvas.clientWidth, canvas.clientHeight, courseUp);
}

function frame() {
  requestAnimationFrame(frame);
  const now = performance.now();
  if (!dirty && now - drawn < REDRAW_MS) return;
  dirty = false;
  drawn = now;
  frames++;
  const pen = surface.ready();
  const scope = scopeNow();
  draw(pen, state, settings, scope, colors, marks, seconds());
  panel.showCorners(state, settings, scope, marks, pointer);
  if (now - panelShown > PANEL_MS) {
    panelShown = now;
    showPanel();
  }
}

function showPanel() {
  const mayCommand = state.role.commands;
  panel.showOwnShip(state);
  panel.showAlarms(state, mayCommand, (number) => command('acknowledge', { number }));
  panel.showSelected(chosen());
  showTargets(state.targets, sorted, marks.id, choose);
  panel.showState(state);
  for (const id of ['acknowledge-all', 'acquire', 'cancel', 'trial-off']) {
    /** @type {HTMLButtonElement} */ (panel.element(id)).disabled = !mayCommand;
  }
  for (const button of document.querySelectorAll('form .submit')) button.disabled = !mayCommand;
}

const showAlive = () => alive({ state, settings, sound, surface }, seconds());

function applySettings() {
  document.documentElement.dataset.obcTheme = settings.palette;
  const style = getComputedStyle(document.documentElement);
  colors = Object.fromEntries(
    [
      'sea',
      'ring',
      'scale',
      'echo',
      'trail',
      'target',
      'coasting',
      'danger',
      'lost',
      'label',
      'own',
      'selected',
      'cursor',
      'marker',
      'safe',
    ].map((name) => [name, style.getPropertyValue(`--${name}`).trim()]),
  );
  const words = {
    orientation: settings.orientation,
    vectors: `Vectors ${settings.vectors}`,
    vectorMinutes: `${settings.vectorMinutes} min`,
    trails: `Trails ${settings.trails}`,
    trailMinutes: `${settings.trailMinutes} min`,
    offCentre: `Off centre ${settings.offCentre}`,
    rings: `Rings ${settings.rings}`,
    labels: `Numbers ${settings.labels}`,
    palette: settings.palette,
    sound: `Sound ${settings.sound}`,
  };
  for (const button of document.querySelectorAll('[data-next]')) {
    panel.say(button, words[/** @type {HTMLElement} */ (button).dataset.next]);
  }
  dirty = true;
}

// -- in --------------------------------------------------------------------------------------

function change(/** @type {string} */ name, /** @type {any} */ value) {
  settings[name] = value;
  if (name === 'orientation') courseUp = state.own?.heading ?? 0;
  keep(settings);
  applySettings();
}

function zoom(/** @type {number} */ step) {
  change('range', Math.min(Math.max(settings.range + step, 0), RANGES.length - 1));
}

async function command(/** @type {string} */ name, values = {}) {
  const { ok, text } = await link.send(name, values);
  const said = panel.element('said');
  panel.say(said, `${ok ? '' : 'Not done: '}${text.split(';')[0]}`);
  clearTimeout(saidUntil);
  saidUntil = setTimeout(() => panel.say(said, ''), 6000);
}

const chosen = () => state.targets.find((target) => target.id === marks.id);

function choose(/** @type {number|null} */ id) {
  marks.id = id;
  panelShown = -Infinity;
  dirty = true;
}

function chooseNext() {
  const inOrder = [...state.targets].sort((a, b) => b.alarm - a.alarm || a.range - b.range);
  const place = inOrder.findIndex((target) => target.id === marks.id);
  if (inOrder.length) choose(inOrder[(place + 1) % inOrder.length].id);
}

function moveCursor(/** @type {number} */ right, /** @type {number} */ down) {
  const { view } = scopeNow();
  const [x, y] = marks.cursor ? toScreen(view, ...marks.cursor) : [view.centreX, view.centreY];
  marks.cursor = toMap(view, x + right, y + down);
  dirty = true;
}

function selectAt(/** @type {number} */ x, /** @type {number} */ y) {
  const { view } = scopeNow();
  marks.cursor = toMap(view, x, y);
  choose(targetAt(state, view, x, y)?.id ?? null);
}

function acquire() {
  if (marks.cursor) command('acquire', { x: marks.cursor[0], y: marks.cursor[1] });
  else panel.say(panel.element('said'), 'Click where to acquire first, or move the cursor there.');
}

function cancel() {
  const target = chosen();
  if (target?.number) command('cancel', { number: target.number });
}

/** A bearing line with a range marker at the cursor; after two of them, none. */
function mark() {
  const place = marks.cursor ?? (pointer && toMap(scopeNow().view, ...pointer));
  if (marks.lines.length === MOST_LINES) marks.lines = [];
  else if (place && state.own) {
    marks.lines.push(rangeBearing(state.own.x, state.own.y, place[0], place[1]));
  }
  dirty = true;
}

const at = (/** @type {MouseEvent} */ event) =>
  /** @type {[number, number]} */ ([event.offsetX, event.offsetY]);
canvas.addEventListener('pointerdown', (event) => {
  const handle = forms.handleOf(state, settings, scopeNow().view);
  marks.drag = state.role.commands && forms.grips(handle, at(event)) ? at(event) : null;
  dragged = false;
  if (marks.drag) canvas.setPointerCapture(event.pointerId);
});
canvas.addEventListener('pointermove', (event) => {
  pointer = at(event);
  dirty = true;
  if (!marks.drag) return;
  dragged = true;
  marks.drag = pointer;
  forms.dragTo(state, settings, scopeNow().view, pointer);
});
canvas.addEventListener('pointerup', () => {
  if (marks.drag && dragged) forms.tryIt();
  marks.drag = null;
});
canvas.addEventListener('pointerleave', () => {
  pointer = null;
  dirty = true;
});
canvas.addEventListener('click', (event) => {
  if (!dragged) selectAt(...at(event));
});
canvas.addEventListener('dblclick', (event) => {
  selectAt(...at(event));
  if (marks.id === null) acquire();
});
canvas.addEventListener('wheel', (event) => zoom(Math.sign(event.deltaY)), {
  passive: true,
});

const KEYS = {
  '+': () => zoom(-1),
  '=': () => zoom(-1),
  '-': () => zoom(1),
  o: () => change('orientation', next(settings, 'orientation')),
  v: () => change('vectors', next(settings, 'vectors')),
  l: () => change('vectorMinutes', next(settings, 'vectorMinutes')),
  t: () => change('trails', next(settings, 'trails')),
  c: () => change('offCentre', next(settings, 'offCentre')),
  r: () => change('rings', next(settings, 'rings')),
  p: () => change('palette', next(settings, 'palette')),
  n: chooseNext,
  s: () => sound.silence(seconds()),
  e: mark,
  q: acquire,
  a: () =>
    chosen()?.alarm
      ? command('acknowledge', { number: chosen().number })
      : command('acknowledge_all'),
  Delete: cancel,
  Escape: () => choose(null),
};
const ARROWS = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target instanceof HTMLInputElement)
    return;
  if (document.activeElement === canvas) {
    const step = ARROWS[event.key];
    if (step) {
      moveCursor(STEP_PX * step[0], STEP_PX * step[1]);
      event.preventDefault();
    }
    if (event.key === 'Enter' && marks.cursor) {
      selectAt(...toScreen(scopeNow().view, ...marks.cursor));
      if (marks.id === null) acquire();
    }
  }
  KEYS[event.key]?.();
});
for (const button of document.querySelectorAll('[data-next]')) {
  const name = /** @type {HTMLElement} */ (button).dataset.next;
  button.addEventListener('click', () => change(name, next(settings, name)));
}
for (const [id, act] of Object.entries({
  nearer: () => zoom(-1),
  farther: () => zoom(1),
  silence: () => sound.silence(seconds()),
  mark,
  acquire,
  cancel,
  'acknowledge-all': () => command('acknowledge_all'),
  'trial-off': () => command('trial_off'),
})) {
  panel.element(id).addEventListener('click', act);
}
forms.listen(command);
panel.element('trial-box').addEventListener('toggle', () => {
  if (!dragged) forms.fillTrial(state);
});
makeHeads((column) => {
  sorted.sign = sorted.column === column ? -sorted.sign : 1;
  sorted.column = column;
  sorted.danger = column === 6;
  panelShown = -Infinity;
});

new ResizeObserver(() => {
  dirty = true;
}).observe(canvas);
applySettings();
showAlive();
setInterval(showAlive, ALIVE_MS);
canvas.addEventListener('contextlost', () => {
  showAlive();
  dirty = true;
});
requestAnimationFrame(frame);

// For tests, and for whoever looks from the console.
window.ppi = {
  state,
  settings,
  marks,
  sound,
  surface,
  frames: () => frames,
  redraw: () => {
    dirty = true;
  },
  scopeNow,
  toScreen,
  toMap,
  rangeBearing,
  CHOICES,
};
