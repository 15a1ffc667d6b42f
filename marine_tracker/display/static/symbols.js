// The symbols of SN.1/Circ.243 for radar targets and own ship, drawn at a pixel.

/** @typedef {CanvasRenderingContext2D} Canvas */

const RADIUS = 7; // px, of a target's circle
const THIN = 1.6;
const BOLD = 3.2;

function circle(/** @type {Canvas} */ canvas, x, y, radius) {
  canvas.beginPath();
  canvas.arc(x, y, radius, 0, 2 * Math.PI);
  canvas.stroke();
}

function diagonals(/** @type {Canvas} */ canvas, x, y, arm) {
  canvas.beginPath();
  canvas.moveTo(x - arm, y - arm);
  canvas.lineTo(x + arm, y + arm);
  canvas.moveTo(x - arm, y + arm);
  canvas.lineTo(x + arm, y - arm);
  canvas.stroke();
}

/** Tracked: a circle. Its inside shows how likely the danger is. */
export function tracked(/** @type {Canvas} */ canvas, x, y, color, likely, dangerColor) {
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  if (likely > 0.01) {
    canvas.globalAlpha = 0.6 * likely;
    canvas.fillStyle = dangerColor;
    canvas.beginPath();
    canvas.arc(x, y, RADIUS, 0, 2 * Math.PI);
    canvas.fill();
    canvas.globalAlpha = 1;
  }
  circle(canvas, x, y, RADIUS);
}

/** Being acquired by hand: a circle in segments. */
export function acquiring(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = THIN;
  segments(canvas, x, y, color, RADIUS);
}

/** Acquired in a guard zone: the same, bold; the caller leaves it out now and then. */
export function caught(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = BOLD;
  segments(canvas, x, y, color, RADIUS + 2);
}

function segments(canvas, x, y, color, radius) {
  canvas.strokeStyle = color;
  for (let part = 0; part < 4; part++) {
    const middle = (part * Math.PI) / 2 + Math.PI / 4;
    canvas.beginPath();
    canvas.arc(x, y, radius, middle - 0.5, middle + 0.5);
    canvas.stroke();
  }
}

/** Dangerous: a bold red circle; the caller leaves it out now and then until acknowledged. */
export function dangerous(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = BOLD;
  canvas.strokeStyle = color;
  circle(canvas, x, y, RADIUS + 1);
}

/** Coasting, no plot in the last scan: a circle with a gap below. */
export function coasting(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  canvas.beginPath();
  canvas.arc(x, y, RADIUS, Math.PI / 2 + 0.6, Math.PI / 2 - 0.6 + 2 * Math.PI);
  canvas.stroke();
}

/** Lost: bold lines across the circle. */
export function lost(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  circle(canvas, x, y, RADIUS);
  canvas.lineWidth = BOLD;
  diagonals(canvas, x, y, RADIUS + 3);
}

/** Selected: the corners of a square around the target. */
export function selected(/** @type {Canvas} */ canvas, x, y, color) {
  const half = RADIUS + 6;
  const arm = 6;
  canvas.lineWidth = 2;
  canvas.strokeStyle = color;
  canvas.beginPath();
  for (const [right, down] of [
    [-1, -1],
    [1, -1],
    [1, 1],
    [-1, 1],
  ]) {
    canvas.moveTo(x + right * (half - arm), y + down * half);
    canvas.lineTo(x + right * half, y + down * half);
    canvas.lineTo(x + right * half, y + down * (half - arm));
  }
  canvas.stroke();
}

/** A vector: short dashes, from the edge of the circle on. */
export function vector(/** @type {Canvas} */ canvas, x, y, right, down, color, bold) {
  const length = Math.hypot(right, down);
  if (length < RADIUS) return;
  const begin = RADIUS / length;
  canvas.lineWidth = bold ? BOLD : THIN;
  canvas.strokeStyle = color;
  canvas.setLineDash([5, 3]);
  canvas.beginPath();
  canvas.moveTo(x + begin * right, y + begin * down);
  canvas.lineTo(x + right, y + down);
  canvas.stroke();
  canvas.setLineDash([]);
}

/** A past position: a dot. */
export function pastPosition(/** @type {Canvas} */ canvas, x, y) {
  canvas.beginPath();
  canvas.arc(x, y, 1.7, 0, 2 * Math.PI);
  canvas.fill();
}

/** Own ship: a double circle. */
export function ownShip(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  circle(canvas, x, y, 4);
  circle(canvas, x, y, 8);
}

/** Heads at the end of own ship's vector: one through the water, two over ground. */
export function arrowheads(/** @type {Canvas} */ canvas, x, y, right, down, color, heads) {
  const length = Math.hypot(right, down);
  if (length < 2 * RADIUS) return;
  const [ahead, abeam] = [right / length, down / length];
  canvas.lineWidth = BOLD - 1;
  canvas.strokeStyle = color;
  canvas.beginPath();
  for (let head = 0; head < heads; head++) {
    const [tipX, tipY] = [x + right - 7 * head * ahead, y + down - 7 * head * abeam];
    canvas.moveTo(tipX - 8 * ahead - 5 * abeam, tipY - 8 * abeam + 5 * ahead);
    canvas.lineTo(tipX, tipY);
    canvas.lineTo(tipX - 8 * ahead + 5 * abeam, tipY - 8 * abeam - 5 * ahead);
  }
  canvas.stroke();
}

/**
 * A hull to scale, pointed at the bow.
 * @param {Canvas} canvas @param {number} x px, of the point that `bow` is measured from
 * @param {{length: number, beam: number, bow: number, heading: number}} hull  m, rad
 * @param {import('./geometry.js').View} view
 */
export function hull(canvas, x, y, { length, beam, bow, heading }, view, color) {
  const shoulder = bow - Math.min(beam, length / 3);
  canvas.save();
  canvas.translate(x, y);
  canvas.rotate(heading - view.up);
  canvas.scale(view.scale, view.scale);
  canvas.beginPath();
  canvas.moveTo(0, -bow);
  for (const [right, ahead] of [
    [beam / 2, shoulder],
    [beam / 2, bow - length],
    [-beam / 2, bow - length],
    [-beam / 2, shoulder],
  ]) {
    canvas.lineTo(right, -ahead);
  }
  canvas.closePath();
  canvas.restore();
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  canvas.stroke();
}

/** The reference point in own ship's outline. */
export function cross(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  canvas.beginPath();
  canvas.moveTo(x - 4, y);
  canvas.lineTo(x + 4, y);
  canvas.moveTo(x, y - 4);
  canvas.lineTo(x, y + 4);
  canvas.stroke();
}

const [HALF_BASE, HALF_HEIGHT] = [7, 11]; // px, of the triangle of an activated ship of AIS
const ASLEEP = 0.72; // of that

/** A ship of AIS: an acute triangle about her place; asleep small, of unknown CPA broken. */
export function triangle(/** @type {Canvas} */ canvas, x, y, angle, color, look) {
  const scale = look.sleeping ? ASLEEP : 1;
  canvas.lineWidth = look.bold ? BOLD : THIN;
  canvas.strokeStyle = color;
  canvas.save();
  canvas.translate(x, y);
  canvas.rotate(angle);
  canvas.setLineDash(look.broken ? [3, 2] : []);
  canvas.beginPath();
  canvas.moveTo(0, -scale * HALF_HEIGHT);
  canvas.lineTo(scale * HALF_BASE, scale * HALF_HEIGHT);
  canvas.lineTo(-scale * HALF_BASE, scale * HALF_HEIGHT);
  canvas.closePath();
  canvas.stroke();
  canvas.setLineDash([]);
  canvas.restore();
}

/** Her heading: a solid line from the apex, two triangles long, with a flag where she turns. */
export function headingLine(/** @type {Canvas} */ canvas, x, y, angle, color, flag) {
  const end = -5 * HALF_HEIGHT;
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  canvas.save();
  canvas.translate(x, y);
  canvas.rotate(angle);
  canvas.beginPath();
  canvas.moveTo(0, -HALF_HEIGHT);
  canvas.lineTo(0, end);
  if (flag) canvas.lineTo(flag * HALF_BASE, end);
  canvas.stroke();
  canvas.restore();
}

/** Lost: a bold cross over the triangle. */
export function across(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = BOLD;
  canvas.strokeStyle = color;
  diagonals(canvas, x, y, HALF_HEIGHT);
}

/** An AIS-SART: a circle with a cross in it. */
export function beacon(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  circle(canvas, x, y, RADIUS + 1);
  diagonals(canvas, x, y, (RADIUS + 1) * Math.SQRT1_2);
}

/** An aid to navigation: a diamond with a crosshair. */
export function aid(/** @type {Canvas} */ canvas, x, y, color) {
  const arm = RADIUS + 1;
  canvas.beginPath();
  canvas.moveTo(x, y - arm);
  canvas.lineTo(x + arm, y);
  canvas.lineTo(x, y + arm);
  canvas.lineTo(x - arm, y);
  canvas.closePath();
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  canvas.stroke();
  cross(canvas, x, y, color);
}
