// How the map lies on the screen: range, orientation, motion, own ship off centre. Drawing, clicking
// and dragging all ask `scopeOf`, so they agree.

import { NAUTICAL_MILE, direction, toMap, turned } from './geometry.js';
import { RANGES } from './settings.js';

export const FARTHEST_OFF = 0.75; // of the radius: own ship is never farther off the middle
const AHEAD = 0.5; // of the radius: how far she is moved back for the view ahead
const MARGIN = 40; // px, for the bearing scale
const LEAST_SPEED = 0.3; // m/s, below which her course is that of her bow

/**
 * @typedef {import('./geometry.js').View} View
 * @typedef {import('./state.js').State} State
 * @typedef {import('./settings.js').Settings} Settings
 * @typedef {object} Scope
 * @property {View} view
 * @property {number} middleX  px, of the picture's circle
 * @property {number} middleY
 * @property {number} radius
 * @property {string} orientation  as it is: head-up where no heading is known
 * @property {string} motion       as it is: true or relative
 * @property {boolean} north       whether true north is known; else bearings are relative only
 * @typedef {object} Held          what stays from one picture to the next
 * @property {number} courseUp     rad, when course-up was chosen
 * @property {[number, number]|null} anchor  map position in the middle, m, in true motion
 */

/** @returns {Held} */
export const newHeld = () => ({ courseUp: 0, anchor: null });

/** The bearing of own ship's bow in the map, rad: her heading, or the last one known. */
export const bowOf = (own) => own?.heading ?? own?.bow ?? 0;

/** m from the middle to the edge. */
export const radiusOf = (/** @type {Settings} */ settings) =>
  RANGES[settings.range][0] * NAUTICAL_MILE;

/** Whether the picture is in true motion: head-up it never is. */
const inTrueMotion = (state, settings) =>
  settings.motion === 'true' && settings.orientation !== 'head-up' && state.own?.heading != null;

/**
 * In true motion own ship moves over the picture. Where she comes too near the edge the picture is
 * reset: she starts again half a radius behind the middle, for the longest view ahead. Call it
 * before `scopeOf`.
 */
export function keepInSight(
  /** @type {Held} */ held,
  /** @type {State} */ state,
  /** @type {Settings} */ settings,
) {
  if (!inTrueMotion(state, settings)) {
    held.anchor = null;
    return;
  }
  const own = /** @type {any} */ (state.own);
  const farthest = FARTHEST_OFF * radiusOf(settings) + 1e-6;
  if (!held.anchor || Math.hypot(own.x - held.anchor[0], own.y - held.anchor[1]) > farthest) {
    held.anchor = resetAnchor(own, settings);
  }
}

/** The middle of the picture that has own ship behind it on her course. @returns {[number, number]} */
export function resetAnchor(own, /** @type {Settings} */ settings) {
  const moves = Math.hypot(own.vx, own.vy) > LEAST_SPEED;
  const course = moves ? Math.atan2(own.vx, own.vy) : bowOf(own);
  const way = AHEAD * radiusOf(settings);
  return [own.x + way * Math.sin(course), own.y + way * Math.cos(course)];
}

/**
 * How the map lies on the screen at this moment.
 * @param {State} state @param {Settings} settings
 * @param {number} width px @param {number} height px @param {Held} held
 * @returns {Scope}
 */
export function scopeOf(state, settings, width, height, held) {
  const radius = Math.max(Math.min(width, height) / 2 - MARGIN, 40);
  const own = state.own;
  const north = !own || own.heading !== null;
  const orientation = north ? settings.orientation : 'head-up';
  const up = { 'north-up': 0, 'course-up': held.courseUp }[orientation] ?? bowOf(own);
  const view = {
    originX: own?.x ?? 0,
    originY: own?.y ?? 0,
    centreX: width / 2,
    centreY: height / 2,
    scale: radius / radiusOf(settings),
    up,
  };
  const moves = held.anchor !== null && inTrueMotion(state, settings);
  const [right, down] = moves
    ? turned(view, view.originX - held.anchor[0], view.originY - held.anchor[1])
    : offsetOf(view, settings, own).map((part) => part * radius);
  view.centreX += right;
  view.centreY += down;
  const motion = moves ? 'true' : 'relative';
  return { view, middleX: width / 2, middleY: height / 2, radius, orientation, motion, north };
}

/** Radii to the right and down from the middle to own ship, in relative motion. */
function offsetOf(view, settings, own) {
  if (settings.offCentre === 'place') return [settings.offRight, settings.offDown];
  if (settings.offCentre !== 'ahead' || !own) return [0, 0];
  return direction(view, bowOf(own)).map((part) => -AHEAD * part);
}

/**
 * Own ship's symbol comes to a pixel, or as near to it as FARTHEST_OFF allows.
 * @param {Scope} scope @param {Held} held @param {[number, number]} pixel
 * @returns {{settings: object, anchor: [number, number]|null, all: boolean}} what changes; whether
 *     she is where she was asked to be
 */
export function putOwnShip(scope, held, [x, y]) {
  const { view, middleX, middleY, radius } = scope;
  const [right, down] = [(x - middleX) / radius, (y - middleY) / radius];
  const away = Math.hypot(right, down);
  const part = Math.min(1, FARTHEST_OFF / Math.max(away, 1e-9));
  const place = { offCentre: 'place', offRight: right * part, offDown: down * part };
  const all = away <= FARTHEST_OFF;
  if (!held.anchor) return { settings: place, anchor: null, all };
  // The middle is as far from the place that she goes to, as it is from where she is in the map.
  const there = { ...view, centreX: middleX + place.offRight * radius };
  there.centreY = middleY + place.offDown * radius;
  return { settings: {}, anchor: toMap(there, middleX, middleY), all };
}

/** How far rings are to be drawn, m: to the farthest edge as seen from own ship. */
export function farthestSeen({ view, middleX, middleY, radius }) {
  return (radius + Math.hypot(view.centreX - middleX, view.centreY - middleY)) / view.scale;
}
