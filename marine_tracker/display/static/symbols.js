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

/** Being acquired: a circle in segments. */
export function acquiring(/** @type {Canvas} */ canvas, x, y, color) {
  canvas.lineWidth = THIN;
  canvas.strokeStyle = color;
  for (let part = 0; part < 4; part++) {
    const middle = (part * Math.PI) / 2 + Math.PI / 4;
    canvas.beginPath();
    canvas.arc(x, y, RADIUS, middle - 0.5, middle + 0.5);
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
  const arm = RADIUS + 3;
  canvas.beginPath();
  canvas.moveTo(x - arm, y - arm);
  canvas.lineTo(x + arm, y + arm);
  canvas.moveTo(x - arm, y + arm);
  canvas.lineTo(x + arm, y - arm);
  canvas.stroke();
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
