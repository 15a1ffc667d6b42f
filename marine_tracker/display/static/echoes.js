// Echoes with their afterglow, written pixel by pixel: a dozen scans of a thousand plots cost no more
// than the copy of one image.

import { turned } from './geometry.js';
import { serverNow } from './state.js';

const GLOW_S = 30; // an echo has faded after so long
const SILENT_S = 60; // after which the last echoes of one of several radars go, too
const FADE_STEP_S = 0.5; // between two steps of the fading
const FRESH_PX = 3.5;
const OLD_PX = 3;

/** What the echoes' picture depends on. @param {import('./state.js').State} state */
export function echoKey(state, /** @type {number} */ local) {
  const newest = state.plots[state.plots.length - 1];
  return newest
    ? [newest.stamp, newest.radar, state.plots.length, Math.floor(local / FADE_STEP_S)]
    : [];
}

/**
 * @param {OffscreenCanvasRenderingContext2D} pen  in CSS pixels; its canvas is overwritten
 * @param {import('./state.js').State} state
 * @param {import('./geometry.js').View} view
 * @param {string} color  #rrggbb
 * @param {number} local s
 */
export function paintEchoes(pen, state, view, color, local) {
  const { width, height } = pen.canvas;
  const ratio = pen.getTransform().a;
  const image = pen.createImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  const [red, green, blue] = [1, 3, 5].map((k) => parseInt(color.slice(k, k + 2), 16));
  const now = serverNow(state, local);
  // A metre to the east and one to the north, on the screen: turned as everything else is.
  const east = turned(view, ratio, 0);
  const north = turned(view, 0, ratio);
  const [middleX, middleY] = [view.centreX * ratio, view.centreY * ratio];
  const last = new Map(state.plots.map((scan) => [scan.radar ?? 0, scan])); // of each radar
  state.plots.forEach((scan) => {
    const age = Math.max(now - scan.at, 0);
    // Of one radar the newest scan stays; of several one that is silent leaves nothing behind.
    // Of a radar that sends sectors the newest scan is what came in a revolution.
    const head = last.get(scan.radar ?? 0);
    const turn = 0.9 * (state.scan?.period ?? 0);
    const fresh = head === scan || (head !== undefined && head.stamp - scan.stamp < turn);
    const newest = fresh && (last.size === 1 || age < SILENT_S);
    const fade = 1 - age / GLOW_S;
    if (fade <= 0 && !newest) return;
    const alpha = Math.round(255 * (newest ? 0.9 : 0.4 * fade ** 2));
    const value = ((alpha << 24) | (blue << 16) | (green << 8) | red) >>> 0;
    const size = Math.max(Math.round((newest ? FRESH_PX : OLD_PX) * ratio), 1);
    for (let k = 0; k < scan.x.length; k++) {
      const dx = scan.x[k] - view.originX;
      const dy = scan.y[k] - view.originY;
      const left = Math.round(middleX + dx * east[0] + dy * north[0] - size / 2);
      const top = Math.round(middleY + dx * east[1] + dy * north[1] - size / 2);
      if (left < 0 || top < 0 || left + size > width || top + size > height) continue;
      for (let row = top; row < top + size; row++) {
        pixels.fill(value, row * width + left, row * width + left + size);
      }
    }
  });
  pen.putImageData(image, 0, 0);
}
