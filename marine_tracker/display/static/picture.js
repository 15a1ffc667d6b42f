// The radar picture on its canvas: scale, rings, echoes, targets, own ship.

import {
  NAUTICAL_MILE,
  canvasAngle,
  direction,
  edge,
  ellipse,
  toScreen,
  turned,
} from './geometry.js';
import { echoKey, paintEchoes } from './echoes.js';
import { placed } from './labels.js';
import { Layer, Stamps } from './layers.js';
import { RANGES } from './settings.js';
import { drawStationary } from './stationary.js';
import { drawMarks, drawScale, drawTrial } from './surround.js';
import {
  ACQUIRING,
  ACKNOWLEDGED,
  COASTING,
  LOST,
  UNACKNOWLEDGED,
  lostTargets,
  nameOf,
} from './state.js';
import * as symbols from './symbols.js';

const MARGIN = 40; // px, for the bearing scale
const OFF = 0.5; // of the radius: how far own ship is moved back when off-centre
const ELLIPSE_SIGMA = 2;
const FLASH_S = 0.5;
const around = new Layer(); // sea, rings, bearing scale
const glow = new Layer(); // echoes
const past = new Layer(); // trails
const stamps = new Stamps();
const LIKELY_STEPS = 20; // of the shade that tells how likely a danger is

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

/** The vector of a target or own ship, m. */
export function vectorOf(/** @type {Settings} */ settings, own, vx, vy) {
  const seconds = 60 * settings.vectorMinutes;
  const relative = settings.vectors === 'relative';
  return [(vx - (relative ? own.vx : 0)) * seconds, (vy - (relative ? own.vy : 0)) * seconds];
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
    drawStationary(canvas, state.fixed, scope.view, colors.trail);
    drawOwnShip(canvas, state, settings, scope, colors);
    drawTargets(canvas, state, settings, scope, colors, marks.id, local);
  }
  drawMarks(canvas, scope, colors, marks);
  canvas.restore();
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

function drawOwnShip(canvas, state, settings, scope, colors) {
  const { view, middleX, middleY, radius } = scope;
  const own = state.own;
  if (own.heading !== null) {
    const [x, y] = edge(view, own.heading, middleX, middleY, radius);
    canvas.strokeStyle = colors.own;
    canvas.lineWidth = 1.4;
    canvas.beginPath();
    canvas.moveTo(view.centreX, view.centreY);
    canvas.lineTo(x, y);
    canvas.stroke();
  }
  if (settings.vectors === 'true') {
    const [right, down] = turned(view, ...vectorOf(settings, own, own.vx, own.vy));
    symbols.vector(canvas, view.centreX, view.centreY, right, down, colors.own, true);
  }
  symbols.ownShip(canvas, view.centreX, view.centreY, colors.own);
}

function drawTargets(canvas, state, settings, scope, colors, chosen, local) {
  const { view, middleX, middleY, radius } = scope;
  const shown = Math.floor(local / FLASH_S) % 2 === 0;
  /** @type {import('./labels.js').Label[]} */
  const labels = [];
  const inOrder = [...state.targets].sort((a, b) => a.alarm - b.alarm); // the dangerous on top
  for (const target of inOrder) {
    if (target.x === null || target.status === LOST) continue;
    const [x, y] = toScreen(view, target.x, target.y);
    const danger = target.alarm >= ACKNOWLEDGED;
    const color = danger
      ? colors.danger
      : target.status === COASTING
        ? colors.coasting
        : colors.target;
    const [right, down] = turned(view, ...vectorOf(settings, state.own, target.vx, target.vy));
    const beyond = Math.hypot(x - middleX, y - middleY) - radius;
    if (danger && beyond > 0 && shown) drawBeyond(canvas, scope, target, colors);
    if (beyond > Math.hypot(right, down)) continue;
    if (target.id === chosen) {
      symbols.selected(canvas, x, y, colors.selected);
      drawEllipse(canvas, view, target, colors);
    }
    if (target.alarm !== UNACKNOWLEDGED || shown) {
      if (target.status !== ACQUIRING) symbols.vector(canvas, x, y, right, down, color, danger);
      drawSymbol(canvas, target, x, y, color, danger, colors);
    }
    if (target.number && (settings.labels === 'on' || danger || target.id === chosen)) {
      const text = String(target.number).padStart(2, '0');
      labels.push({ x, y, text, needed: danger || target.id === chosen });
    }
  }
  for (const alarm of lostTargets(state)) {
    if (!shown && alarm.state.endsWith('unacknowledged')) continue;
    const [x, y] = toScreen(view, alarm.x, alarm.y);
    symbols.lost(canvas, x, y, colors.lost);
    if (alarm.number) labels.push({ x, y, text: nameOf(alarm).slice(2), needed: false });
  }
  canvas.font = '600 13px system-ui, sans-serif';
  canvas.textBaseline = 'middle';
  canvas.textAlign = 'left';
  canvas.fillStyle = colors.label;
  for (const { label, left, middle } of placed(labels, (text) => widthOf(canvas, text))) {
    canvas.fillText(label.text, left, middle);
  }
}

function drawSymbol(canvas, target, x, y, color, danger, colors) {
  const likely = Math.round((target.danger_probability ?? 0) * LIKELY_STEPS);
  const key = `${color} ${danger} ${target.status} ${likely}`;
  stamps.put(canvas, key, x, y, 12, (pen, middleX, middleY) => {
    if (danger) symbols.dangerous(pen, middleX, middleY, color);
    else if (target.status === ACQUIRING) symbols.acquiring(pen, middleX, middleY, color);
    else if (target.status === COASTING) symbols.coasting(pen, middleX, middleY, color);
    else symbols.tracked(pen, middleX, middleY, color, likely / LIKELY_STEPS, colors.danger);
  });
}

/** @type {Map<string, number>} */
const widths = new Map();

/** The width of a label, px: measured once, there are few different ones. */
function widthOf(canvas, /** @type {string} */ text) {
  const known = widths.get(text) ?? canvas.measureText(text).width;
  if (widths.size < 5000) widths.set(text, known);
  return known;
}

/** A dangerous target beyond the edge: a triangle on its bearing. */
function drawBeyond(canvas, { view, middleX, middleY, radius }, target, colors) {
  const bearing = Math.atan2(target.x - view.originX, target.y - view.originY);
  const [x, y] = edge(view, bearing, middleX, middleY, radius - 3);
  const [right, down] = [(x - middleX) / radius, (y - middleY) / radius];
  canvas.fillStyle = colors.danger;
  canvas.beginPath();
  canvas.moveTo(x, y);
  canvas.lineTo(x - 16 * right - 8 * down, y - 16 * down + 8 * right);
  canvas.lineTo(x - 16 * right + 8 * down, y - 16 * down - 8 * right);
  canvas.fill();
}

function drawEllipse(canvas, view, target, colors) {
  const { long, short, bearing } = ellipse(target.xx, target.xy, target.yy);
  canvas.strokeStyle = colors.selected;
  canvas.lineWidth = 1;
  canvas.beginPath();
  const [x, y] = toScreen(view, target.x, target.y);
  const size = ELLIPSE_SIGMA * view.scale;
  canvas.ellipse(x, y, long * size, short * size, canvasAngle(view, bearing), 0, 2 * Math.PI);
  canvas.stroke();
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
