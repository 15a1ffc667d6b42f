// Stationary objects: places where plots always are. No targets, so small, dim and without vector.

import { toScreen } from './geometry.js';

const HALF = 2.5; // px, of the square

/**
 * @param {CanvasRenderingContext2D} canvas
 * @param {[number, number, number][]} fixed  number, x and y in m
 * @param {import('./geometry.js').View} view @param {string} color
 */
export function drawStationary(canvas, fixed, view, color) {
  canvas.strokeStyle = color;
  canvas.lineWidth = 1;
  canvas.beginPath();
  for (const [, east, north] of fixed) {
    const [x, y] = toScreen(view, east, north);
    canvas.rect(x - HALF, y - HALF, 2 * HALF, 2 * HALF);
  }
  canvas.stroke();
}
