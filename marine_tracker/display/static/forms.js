// Trial manoeuvre and danger limits: their forms, and own ship's vector as a handle to drag.

import { KNOT, degrees, radians, rangeBearing, toMap, toScreen, wrap } from './geometry.js';
import { element } from './panel.js';

const GRIP = 16; // px around the handle
const LEAST = 40; // px from own ship to the handle: a ship at rest has one, too

const form = (/** @type {string} */ id) => /** @type {HTMLFormElement} */ (element(id));

let opening = false; // the trial's box, for a vector that was dragged

/** Numbers of a form go out as the command of its name. */
export function listen(/** @type {import('./app.js').App} */ app) {
  element('trial-box').addEventListener('toggle', () => {
    if (!opening) fillTrial(app.state);
    opening = false;
  });
  for (const id of ['trial', 'limits']) {
    form(id)
      .querySelector('.submit')
      .addEventListener('click', () => form(id).requestSubmit());
    form(id).addEventListener('submit', (event) => {
      event.preventDefault();
      const given = [...new FormData(form(id))].map(([key, value]) => [key, Number(value)]);
      app.command(id, Object.fromEntries(given));
    });
  }
}

/** The tracker's limits into their form, unless somebody types there. */
export function fillLimits(/** @type {Record<string, number>} */ limits) {
  if (form('limits').contains(document.activeElement)) return;
  form('limits').elements.cpa_nm.value = limits.cpa_limit_nm;
  form('limits').elements.tcpa_min.value = limits.tcpa_limit_min;
}

/** A trial begins from what own ship does now. */
function fillTrial(/** @type {import('./state.js').State} */ state) {
  if (!state.own || state.trial.on) return;
  const [speed, course] = wayOf(state.own);
  setTrial(degrees(wrap(course)), speed / KNOT);
}

function setTrial(/** @type {number} */ course, /** @type {number} */ speed) {
  form('trial').elements.course_deg.value = Math.round(course) % 360;
  form('trial').elements.speed_kn.value = Math.min(speed, 100).toFixed(1);
}

/** m/s and bearing that own ship's vector stands for: of the trial while there is one. */
function motionOf(state) {
  const { own, trial } = state;
  return trial.on && trial.course_deg !== null
    ? [trial.speed_kn * KNOT, radians(trial.course_deg)]
    : wayOf(own);
}

/** m/s and course of own ship, as the targets' courses are measured; her heading where she is at rest. */
function wayOf(own) {
  const [wx, wy] = [own.wx ?? own.vx, own.wy ?? own.vy];
  const speed = Math.hypot(wx, wy);
  return [speed, speed > 0.25 ? Math.atan2(wx, wy) : (own.heading ?? 0)];
}

/**
 * Where own ship's vector is taken hold of: its end, px. Null where there is none.
 * @returns {[number, number]|null}
 */
export function handleOf(state, settings, view) {
  if (!state.own || settings.vectors !== 'true') return null;
  const [speed, bearing] = motionOf(state);
  const length = Math.max(speed * 60 * settings.vectorMinutes, LEAST / view.scale);
  return toScreen(
    view,
    view.originX + length * Math.sin(bearing),
    view.originY + length * Math.cos(bearing),
  );
}

/** Whether a pixel is on the handle. */
export function grips(handle, [x, y]) {
  return handle !== null && Math.hypot(handle[0] - x, handle[1] - y) <= GRIP;
}

/** The course and speed whose vector ends at a pixel, into the form. */
export function dragTo(state, settings, view, [x, y]) {
  const [away, bearing] = rangeBearing(view.originX, view.originY, ...toMap(view, x, y));
  setTrial(degrees(bearing), away / (60 * settings.vectorMinutes) / KNOT);
}

/** As typed: the trial in the form goes out. */
export function tryIt() {
  const box = /** @type {HTMLDetailsElement} */ (element('trial-box'));
  opening = !box.open;
  box.open = true;
  form('trial').requestSubmit();
}
