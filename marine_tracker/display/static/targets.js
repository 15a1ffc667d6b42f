// The targets on the picture: symbols, vectors, hulls, ellipses, labels, where some were lost.

import { direction, drawOutline, flagOf } from './ais.js';
import { canvasAngle, edge, ellipse, toScreen, turned } from './geometry.js';
import { placed } from './labels.js';
import { Stamps } from './layers.js';
import { byTrack } from './ships.js';
import {
  ACKNOWLEDGED,
  ACQUIRING,
  COASTING,
  LOST,
  UNACKNOWLEDGED,
  lostTargets,
  nameOf,
  newTargets,
  waits,
} from './state.js';
import * as symbols from './symbols.js';
import { vectorOf } from './vectors.js';

const ELLIPSE_SIGMA = 2;
const FLASH_S = 0.5;
const LIKELY_STEPS = 20; // of the shade that tells how likely a danger is
const HULL_PX = 20; // least length of a hull that is drawn: longer than the symbol
const stamps = new Stamps();

/**
 * @param {CanvasRenderingContext2D} canvas
 * @param {import('./state.js').State} state @param {import('./settings.js').Settings} settings
 * @param {import('./scope.js').Scope} scope @param {Record<string, string>} colors
 * @param {number|null} chosen  track of the selected target @param {number} local s
 * @param {import('./labels.js').Label[]} others  more labels: they take the room that is left
 */
export function drawTargets(canvas, state, settings, scope, colors, chosen, local, others) {
  const { view, middleX, middleY, radius } = scope;
  const shown = Math.floor(local / FLASH_S) % 2 === 0;
  const fresh = newTargets(state);
  const joined = byTrack(state.ships);
  /** @type {import('./labels.js').Label[]} */
  const labels = [];
  const inOrder = [...state.targets].sort((a, b) => a.alarm - b.alarm); // the dangerous on top
  for (const target of inOrder) {
    if (target.x === null || target.status === LOST) continue;
    const [x, y] = toScreen(view, target.x, target.y);
    const danger = target.alarm >= ACKNOWLEDGED;
    const caught = !danger && fresh.has(target.number); // in a guard zone, not acknowledged yet
    const color =
      danger || caught
        ? colors.danger
        : target.status === COASTING
          ? colors.coasting
          : colors.target;
    const [right, down] = turned(view, ...vectorOf(settings, state.own, target.vx, target.vy));
    const beyond = Math.hypot(x - middleX, y - middleY) - radius;
    if (danger && beyond > 0 && shown) drawBeyond(canvas, scope, target, colors);
    if (beyond > Math.hypot(right, down)) continue;
    if (target.id === chosen) symbols.selected(canvas, x, y, colors.selected);
    if (settings.ellipses === 'all' || (target.id === chosen && settings.ellipses !== 'off')) {
      drawEllipse(canvas, view, target, colors);
    }
    if (target.length !== null && target.length * view.scale >= HULL_PX) {
      const { length, beam, heading } = target;
      symbols.hull(canvas, x, y, { length, beam, bow: length / 2, heading }, view, color);
    }
    const ship = joined.get(target.id); // one symbol for both
    if (ship && target.length === null) drawOutline(canvas, ship, view, x, y, color);
    if (!(target.alarm === UNACKNOWLEDGED || caught) || shown) {
      if (target.status !== ACQUIRING) symbols.vector(canvas, x, y, right, down, color, danger);
      const look = danger ? 'danger' : caught ? 'caught' : target.status;
      const byAis = ship && state.ais?.ais_symbol !== 'radar';
      if (byAis && target.status !== ACQUIRING && !caught) {
        const angle = direction(ship, view.up) - view.up;
        symbols.triangle(canvas, x, y, angle, color, { sleeping: false, bold: danger });
        if (ship.heading !== null) {
          symbols.headingLine(canvas, x, y, angle, color, flagOf(ship));
        }
      } else {
        drawSymbol(canvas, look, target.danger_probability ?? 0, x, y, color, colors.danger);
      }
    }
    const reference = target.number !== 0 && target.number === state.own.reference;
    if (reference) labels.push({ x, y, text: 'R', needed: true });
    if (target.number && (settings.labels === 'on' || danger || target.id === chosen)) {
      const number = String(target.number).padStart(2, '0');
      const text = ship?.name ? `${number} ${ship.name}` : number;
      labels.push({ x, y, text, needed: danger || target.id === chosen });
    }
  }
  for (const alarm of lostTargets(state)) {
    if (!shown && waits(alarm)) continue;
    const [x, y] = toScreen(view, alarm.x, alarm.y);
    symbols.lost(canvas, x, y, colors.lost);
    if (alarm.number) labels.push({ x, y, text: nameOf(alarm).slice(2), needed: false });
  }
  drawLabels(canvas, [...labels, ...others], colors.label);
}

/** state: 'danger', 'caught' or the target's status; probability: of danger. */
function drawSymbol(canvas, state, probability, x, y, color, dangerColor) {
  const likely = Math.round(probability * LIKELY_STEPS);
  stamps.put(canvas, `${color} ${state} ${likely}`, x, y, 12, (pen, middleX, middleY) => {
    if (state === 'danger') symbols.dangerous(pen, middleX, middleY, color);
    else if (state === 'caught') symbols.caught(pen, middleX, middleY, color);
    else if (state === ACQUIRING) symbols.acquiring(pen, middleX, middleY, color);
    else if (state === COASTING) symbols.coasting(pen, middleX, middleY, color);
    else symbols.tracked(pen, middleX, middleY, color, likely / LIKELY_STEPS, dangerColor);
  });
}

function drawLabels(canvas, labels, color) {
  canvas.font = '600 13px system-ui, sans-serif';
  canvas.textBaseline = 'middle';
  canvas.textAlign = 'left';
  canvas.fillStyle = color;
  canvas.strokeStyle = color;
  canvas.lineWidth = 1;
  for (const { label, left, middle, far } of placed(labels, (text) => widthOf(canvas, text))) {
    canvas.fillText(label.text, left, middle);
    if (!far) continue;
    canvas.beginPath();
    canvas.moveTo(left > label.x ? left - 2 : left + widthOf(canvas, label.text) + 2, middle);
    canvas.lineTo(label.x, label.y);
    canvas.stroke();
  }
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

/** Where the target is, with ELLIPSE_SIGMA deviations. */
function drawEllipse(canvas, view, target, colors) {
  const { long, short, bearing } = ellipse(target.xx, target.xy, target.yy);
  canvas.strokeStyle = colors.selected;
  canvas.lineWidth = 2;
  canvas.beginPath();
  const [x, y] = toScreen(view, target.x, target.y);
  const size = ELLIPSE_SIGMA * view.scale;
  canvas.ellipse(x, y, long * size, short * size, canvasAngle(view, bearing), 0, 2 * Math.PI);
  canvas.stroke();
}
