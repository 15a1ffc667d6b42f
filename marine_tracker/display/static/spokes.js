// Radar video: the echoes of each direction as the beam passed it, with afterglow.
//
// Directions are true and their own ship's place of that moment comes with them, so what was placed
// once never turns or moves, whatever own ship does meanwhile. What was not swept is empty.

import { toMap } from './geometry.js';

const GLOW_S = 8; // a direction that was not swept for so long has faded
const FADE_STEP_S = 0.5;
const COARSE = 2; // pixels of the screen to one of this picture, each way
const TURN = 2 * Math.PI;
const OFFSET = 'A'.charCodeAt(0); // of the text that strengths 0 to 15 come as

/**
 * Directions that come in one message.
 * @typedef {object} Part
 * @property {number} at     s of the server, when it came
 * @property {number} x      m, own ship's place
 * @property {number} y
 * @property {number} range  m, of the last sample
 * @property {number} samples  of a direction
 * @property {Uint8Array} seen  1 for each direction that was swept
 * @property {Uint8Array} strength  0 to 15, direction by direction
 */

/** Take a message in. @param {any} state @param {any} message */
export function takeSpokes(state, message) {
  if (state.spokes?.directions !== message.directions || state.spokes.parts !== message.parts) {
    state.spokes = {
      directions: message.directions,
      parts: message.parts,
      held: Array(message.parts).fill(null),
      count: 0,
    };
  }
  const letters = (text) => Uint8Array.from(text, (letter) => letter.charCodeAt(0) - OFFSET);
  state.spokes.held[message.part] = {
    at: message.at,
    x: message.x,
    y: message.y,
    range: message.range,
    samples: message.samples,
    seen: letters(message.seen),
    strength: letters(message.strength),
  };
  state.spokes.count++;
}

/** What the picture depends on. */
export function spokesKey(state, /** @type {number} */ local) {
  return state.spokes ? [state.spokes.count, Math.floor(local / FADE_STEP_S)] : [];
}

/**
 * The strength at a place of the map, 0 to 1 and faded by age; 0 where nothing was swept.
 * @param {any} spokes @param {number} x m @param {number} y m @param {number} now s of the server
 */
export function strengthAt(spokes, x, y, now) {
  let part = spokes.last ?? spokes.held.find(Boolean);
  if (!part) return 0;
  const wide = spokes.directions / spokes.parts;
  // From where own ship was then: her place is that of the direction in which the place lies.
  for (let again = 0; again < 2; again++) {
    const east = x - part.x;
    const north = y - part.y;
    let angle = Math.atan2(east, north);
    if (angle < 0) angle += TURN;
    const direction = Math.floor((angle / TURN) * spokes.directions) % spokes.directions;
    const found = spokes.held[Math.floor(direction / wide)];
    if (!found) return 0;
    if (found !== part && !again && (found.x !== part.x || found.y !== part.y)) {
      part = found;
      continue;
    }
    const within = direction % wide;
    const sample = Math.floor((Math.hypot(east, north) / found.range) * found.samples);
    if (sample >= found.samples || !found.seen[within]) return 0;
    const fade = 1 - Math.max(now - found.at, 0) / GLOW_S;
    return fade <= 0 ? 0 : (found.strength[within * found.samples + sample] / 15) * fade;
  }
  return 0;
}

/**
 * @param {OffscreenCanvasRenderingContext2D} pen  in CSS pixels
 * @param {any} state
 * @param {import('./geometry.js').View} view
 * @param {string} color  #rrggbb
 * @param {number} now  s of the server
 */
export function paintSpokes(pen, state, view, color, now) {
  const ratio = pen.getTransform().a;
  const step = COARSE / ratio; // CSS pixels
  const width = Math.ceil(pen.canvas.width / COARSE);
  const height = Math.ceil(pen.canvas.height / COARSE);
  const image = new ImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  const [red, green, blue] = [1, 3, 5].map((k) => parseInt(color.slice(k, k + 2), 16));
  const rgb = (blue << 16) | (green << 8) | red;
  const [x0, y0] = toMap(view, step / 2, step / 2);
  const right = toMap(view, 1.5 * step, step / 2);
  const down = toMap(view, step / 2, 1.5 * step);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      const x = x0 + column * (right[0] - x0) + row * (down[0] - x0);
      const y = y0 + column * (right[1] - y0) + row * (down[1] - y0);
      const strength = strengthAt(state.spokes, x, y, now);
      if (strength > 0) {
        pixels[row * width + column] = ((Math.round(255 * strength) << 24) | rgb) >>> 0;
      }
    }
  }
  const small = new OffscreenCanvas(width, height);
  const to = small.getContext('2d');
  if (!to) return; // no memory for it just now
  to.putImageData(image, 0, 0);
  pen.drawImage(small, 0, 0, width * step, height * step);
}
