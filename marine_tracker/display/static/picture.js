// The radar picture on its canvas: scale, rings, echoes, targets, own ship.

import { NAUTICAL_MILE, direction, toScreen } from './geometry.js';
import { drawAreas, drawSafeCourses } from './dangers.js';
import { echoKey, paintEchoes } from './echoes.js';
import { Layer, Stamps } from './layers.js';
import { RANGES } from './settings.js';
import { drawOwnShip } from './own_ship.js';
import { drawMarks, drawScale, drawSimulation, drawTrial } from './surround.js';
import { LOST } from './state.js';
import * as symbols from './symbols.js';
import { drawTargets } from './targets.js';

const MARGIN = 40; // px, for the bearing scale
const OFF = 0.5; // of the radius: how far own ship is moved back when off-centre
const around = new Layer(); // sea, rings, bearing scale
const glow = new Layer(); // echoes
const past = new Layer(); // trails
const stamps = new Stamps();

/**
 * @typedef {import('./geometry.js').View} View
 * @typedef {import('./state.js').State} State
 * @typedef {import('./settings.js').Settings} Settings
 * @typedef {object} Scope
 * @property {View} view
 * @property {number} middleX  px, of the picture's circle
 * @property {number} middleY
 * @property {number} radius
 * @property {string} orientation  as it is: north-up where no heading is known
 */

/**
 * How the map lies on the screen at this moment; drawing and clicking ask this.
 * @param {State} state @param {Settings} settings
 * @param {number} width px @param {number} height px @param {number} courseUp rad
 * @returns {Scope}
 */
export function scopeOf(state, settings, width, height, courseUp) {
  const radius = Math.max(Math.min(width, height) / 2 - MARGIN, 40);
  const own = state.own;
  const heading = own?.heading ?? null;
  const orientation = heading === null ? 'north-up' : settings.orientation;
  const up = { 'north-up': 0, 'head-up': heading ?? 0, 'course-up': courseUp }[orientation] ?? 0;
  const view = {
    originX: own?.x ?? 0,
    originY: own?.y ?? 0,
    centreX: width / 2,
    centreY: height / 2,
    scale: radius / (RANGES[settings.range][0] * NAUTICAL_MILE),
    up,
  };
  if (settings.offCentre === 'on' && heading !== null) {
    const [right, down] = direction(view, heading);
    view.centreX -= OFF * radius * right;
    view.centreY -= OFF * radius * down;
  }
  return { view, middleX: width / 2, middleY: height / 2, radius, orientation };
}

/**
 * Draw everything.
 * @param {CanvasRenderingContext2D} canvas  in CSS pixels
 * @param {State} state @param {Settings} settings @param {Scope} scope
 * @param {Record<string, string>} colors
 * @param {import('./surround.js').Marks} marks
 * @param {number} local s
 */
export function draw(canvas, state, settings, scope, colors, marks, local) {
  const { middleX, middleY, radius } = scope;
  canvas.clearRect(0, 0, canvas.canvas.width, canvas.canvas.height);
  const lies = [...Object.values(scope.view), settings.palette];
  around.onto(canvas, [...lies, settings.range, settings.rings], (pen) => {
    pen.fillStyle = colors.sea;
    pen.beginPath();
    pen.arc(middleX, middleY, radius, 0, 2 * Math.PI);
    pen.fill();
    pen.save();
    pen.clip();
    if (settings.rings === 'on') drawRings(pen, settings, scope, colors);
    pen.restore();
    drawScale(pen, scope, colors);
  });
  canvas.save();
  canvas.beginPath();
  canvas.arc(middleX, middleY, radius, 0, 2 * Math.PI);
  canvas.clip();
  if (state.own) {
    glow.onto(canvas, [...lies, ...echoKey(state, local)], (pen) =>
      paintEchoes(pen, state, scope.view, colors.echo, local),
    );
    if (settings.trails !== 'off') {
      const shown = [settings.trails, settings.trailMinutes, state.trails?.count];
      past.onto(canvas, [...lies, ...shown, state.scan?.at], (pen) =>
        drawTrails(pen, state, settings, scope, colors),
      );
    }
    drawAreas(canvas, state, settings, scope, colors, local);
    drawOwnShip(canvas, state, settings, scope, colors);
    drawTargets(canvas, state, settings, scope, colors, marks.id, local);
  }
  drawMarks(canvas, scope, colors, marks);
  canvas.restore();
  drawSafeCourses(canvas, state, settings, scope, colors, local);
  if (state.ship?.source === 'simulation') drawSimulation(canvas, scope, colors);
  if (state.trial.on) drawTrial(canvas, state, scope, colors);
}

function drawRings(canvas, settings, { view, radius }, colors) {
  const [range, spacing] = RANGES[settings.range];
  const far = settings.offCentre === 'on' ? (1 + OFF) * range : range;
  canvas.strokeStyle = colors.ring;
  canvas.lineWidth = 1;
  for (let ring = 1; ring * spacing <= far + 1e-9; ring++) {
    canvas.beginPath();
    canvas.arc(view.centreX, view.centreY, (ring * spacing * radius) / range, 0, 2 * Math.PI);
    canvas.stroke();
  }
}

function drawTrails(canvas, state, settings, { view }, colors) {
  const trails = state.trails;
  if (!trails) return;
  const relative = settings.trails === 'relative';
  const count = Math.round((60 * settings.trailMinutes) / trails.interval);
  const step = Math.max(1, Math.round(count / 12));
  const last = trails.own.length - 1;
  for (const target of state.targets) {
    const trail = trails.targets[target.id];
    if (!trail) continue;
    for (let back = 0; back <= Math.min(count, last); back++) {
      // Dots stay where they are: they hang on whole moments, not on the newest one.
      const moment = last - back;
      if ((trails.count - back) % step || !trail[moment]) continue;
      const [dx, dy] = relative
        ? [state.own.x - trails.own[moment][0], state.own.y - trails.own[moment][1]]
        : [0, 0];
      const [x, y] = toScreen(view, trail[moment][0] + dx, trail[moment][1] + dy);
      stamps.put(canvas, `past ${colors.trail}`, x, y, 3, (pen, middleX, middleY) => {
        pen.fillStyle = colors.trail;
        symbols.pastPosition(pen, middleX, middleY);
      });
    }
  }
}

/** The target under a pixel, or null. */
export function targetAt(/** @type {State} */ state, /** @type {View} */ view, x, y, reach = 18) {
  let found = null;
  for (const target of state.targets) {
    if (target.x === null || target.status === LOST) continue;
    const [tx, ty] = toScreen(view, target.x, target.y);
    const away = Math.hypot(tx - x, ty - y);
    if (away <= reach) {
      reach = away;
      found = target;
    }
  }
  return found;
}
