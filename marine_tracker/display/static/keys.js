// The keyboard: all that a mouse does, and the arrows for the cursor.

import { toMap, toScreen } from './geometry.js';
import { next } from './settings.js';
import { shipsShown } from './ships.js';
import { edit, moveHandle, nextHandle } from './zones_panel.js';

const STEP_PX = 8; // of the cursor
const ARROWS = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
/** Keys that go to the next choice of a setting. */
const SETTINGS = {
  o: 'orientation',
  v: 'vectors',
  l: 'vectorMinutes',
  t: 'trails',
  c: 'offCentre',
  r: 'rings',
  p: 'palette',
  k: 'motion',
  T: 'trailMinutes',
  i: 'labels',
  d: 'areas',
  w: 'safeCourses',
  u: 'ellipses',
  f: 'ships',
};

/** Whether a key is meant for a field that somebody types in. */
const typing = (/** @type {KeyboardEvent} */ event) =>
  event.ctrlKey ||
  event.altKey ||
  event.metaKey ||
  (event.target instanceof Element && event.target.matches('input, select, textarea'));

export function listen(/** @type {import('./app.js').App} */ app) {
  const keys = {
    '+': () => app.zoom(-1),
    '=': () => app.zoom(-1),
    '-': () => app.zoom(1),
    n: () => chooseNext(app),
    s: app.silence,
    e: app.mark,
    q: app.acquire,
    a: () => {
      const { target } = app.chosen();
      return target?.alarm
        ? app.command('acknowledge', { number: target.number })
        : app.command('acknowledge_all');
    },
    b: app.ownShipHere,
    x: app.resetView,
    m: app.measure,
    y: () => (app.marks.cursor ? app.whyAt(app.marks.cursor) : app.why()),
    h: () => app.hide('heading'),
    g: () => app.hide('graphics'),
    '[': () => nextHandle(app, -1),
    ']': () => nextHandle(app, 1),
    Delete: app.cancel,
    Escape: () => escape(app),
  };
  for (const [key, name] of Object.entries(SETTINGS)) {
    keys[key] = () => app.change(name, next(app.settings, name));
  }
  document.addEventListener('keydown', (event) => {
    if (typing(event)) return;
    if (document.activeElement === app.canvas) onPicture(app, event);
    keys[event.key]?.();
  });
}

/** Ends what is going on: a question, a zone that is being changed, at last the selection. */
function escape(app) {
  if (app.asking) app.stopAsking();
  else if (app.marks.draft) edit(app, null);
  else app.choose(null);
}

function onPicture(app, /** @type {KeyboardEvent} */ event) {
  const step = ARROWS[event.key];
  if (step) {
    const move = event.shiftKey ? moveHandle : moveCursor;
    move(app, STEP_PX * step[0], STEP_PX * step[1]);
    event.preventDefault();
  }
  if (event.key === 'Enter' && app.marks.cursor) {
    const asked = app.asking !== null;
    app.selectAt(...toScreen(app.scopeNow().view, ...app.marks.cursor));
    if (!asked && app.marks.id === null) app.acquire();
  }
}

function moveCursor(app, /** @type {number} */ right, /** @type {number} */ down) {
  const { view } = app.scopeNow();
  const { cursor } = app.marks;
  const [x, y] = cursor ? toScreen(view, ...cursor) : [view.centreX, view.centreY];
  app.marks.cursor = toMap(view, x + right, y + down);
  app.redraw();
}

function chooseNext(app) {
  const { state, settings } = app;
  const all = [...state.targets, ...shipsShown(state, settings)];
  const inOrder = all.sort((a, b) => b.alarm - a.alarm || a.range - b.range);
  const { id } = app.chosen();
  const place = inOrder.findIndex((target) => target.id === id);
  if (inOrder.length) app.choose(inOrder[(place + 1) % inOrder.length].id);
}
