// Mouse, pen and finger on the picture: a click or tap selects, a drag moves what lies there (own
// ship's vector, a zone, a bearing line, a range marker) or else own ship off centre, two fingers
// change the range.

import * as forms from './forms.js';
import { toMap, toScreen } from './geometry.js';
import { gripAt } from './tools.js';
import { zoneGrip } from './zones_panel.js';

const DRAG_PX = 5; // less is a click
const FINGER_PX = 18;
const MOUSE_PX = 9;
const PINCH = 1.4; // the fingers' distance by this factor is one range
const WHEEL = 40; // of a touch pad, for one range

/**
 * @typedef {object} Grab  what is being dragged
 * @property {(pixel: [number, number]) => void} move
 * @property {() => void} [end]
 */

const at = (/** @type {MouseEvent} */ event) =>
  /** @type {[number, number]} */ ([event.offsetX, event.offsetY]);
const apart = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]);

export function listen(/** @type {import('./app.js').App} */ app) {
  const { canvas } = app;
  /** @type {Map<number, [number, number]>} */
  const down = new Map();
  /** @type {Grab|null} */
  let grab = null;
  let dragged = false; // since the last press: then it is no click
  let start = [0, 0];
  let gap = 0; // px between two fingers

  canvas.addEventListener('pointerdown', (event) => {
    down.set(event.pointerId, at(event));
    canvas.setPointerCapture(event.pointerId);
    if (down.size === 2) {
      grab = null;
      dragged = true;
      gap = apart([...down.values()]);
      return;
    }
    dragged = false;
    start = at(event);
    grab = grabAt(app, at(event), event.pointerType === 'touch' ? FINGER_PX : MOUSE_PX);
  });
  canvas.addEventListener('pointermove', (event) => {
    app.pointer = at(event);
    app.redraw();
    if (!down.has(event.pointerId)) return;
    down.set(event.pointerId, app.pointer);
    if (down.size === 2) {
      const wide = apart([...down.values()]);
      if (wide > gap * PINCH || wide < gap / PINCH) {
        app.zoom(wide > gap ? -1 : 1);
        gap = wide;
      }
      return;
    }
    if (!dragged && apart([start, app.pointer]) < DRAG_PX) return;
    if (!dragged && !grab) grab = ownShipFrom(app, start);
    dragged = true;
    grab?.move(app.pointer);
  });
  const up = (/** @type {PointerEvent} */ event) => {
    down.delete(event.pointerId);
    if (event.pointerType === 'touch') app.pointer = null; // no finger, no running readout
    if (dragged && event.type === 'pointerup') grab?.end?.();
    else app.marks.drag = null;
    if (!down.size) grab = null;
    app.redraw();
  };
  canvas.addEventListener('pointerup', up);
  canvas.addEventListener('pointercancel', up);
  canvas.addEventListener('pointerleave', () => {
    app.pointer = null;
    app.redraw();
  });
  canvas.addEventListener('click', (event) => {
    if (!dragged) app.selectAt(...at(event));
  });
  canvas.addEventListener('dblclick', (event) => {
    if (dragged || app.asking) return;
    app.selectAt(...at(event));
    if (app.marks.id === null) app.acquire();
  });
  let wheel = 0;
  canvas.addEventListener(
    'wheel',
    (event) => {
      wheel += event.deltaY;
      if (Math.abs(wheel) < WHEEL) return;
      app.zoom(Math.sign(wheel));
      wheel = 0;
    },
    { passive: true },
  );
}

/** What a press at a pixel takes hold of; null where nothing lies. @returns {Grab|null} */
function grabAt(app, pixel, reach) {
  const { state, settings, marks } = app;
  const { view } = app.scopeNow();
  const vector = state.role.commands && forms.handleOf(state, settings, view);
  if (vector && forms.grips(vector, pixel)) {
    marks.drag = pixel;
    return {
      move(to) {
        marks.drag = to;
        forms.dragTo(state, settings, app.scopeNow().view, to);
      },
      end() {
        forms.tryIt();
        marks.drag = null;
      },
    };
  }
  if (!state.own) return null;
  const screen = (x, y) => toScreen(view, x, y);
  const move =
    zoneGrip(app, view, pixel, reach) ?? gripAt(marks.tools, state.own, view, screen, pixel, reach);
  return move && { move: (to) => move(toMap(app.scopeNow().view, ...to), state.own) };
}

/** The picture itself: own ship goes with the mouse, and stays within her limits. @returns {Grab} */
function ownShipFrom(app, [x0, y0]) {
  const { centreX, centreY } = app.scopeNow().view;
  return { move: ([x, y]) => app.putOwnShip([centreX + x - x0, centreY + y - y0]) };
}
