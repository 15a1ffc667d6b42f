// Echoes of radar video lie where they are, in every orientation, while own ship turns and moves.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const page = new URL('../../../marine_tracker/display/static/', import.meta.url);
const { takeSpokes, strengthAt } = await import(new URL('spokes.js', page));
const { toMap, toScreen, radians } = await import(new URL('geometry.js', page));
const { emptyState, receive } = await import(new URL('state.js', page));

const DIRECTIONS = 512;
const PARTS = 16;
const WIDE = DIRECTIONS / PARTS;
const SAMPLES = 64;
const RANGE = 3200;

/** A turn in which a pier stands at x, y; own ship is at ox, oy when the beam passes a part. */
function turn(state, x, y, place, at = 10, seen = () => true) {
  for (let part = 0; part < PARTS; part++) {
    const [ox, oy] = place(part);
    const bearing = (Math.atan2(x - ox, y - oy) + 2 * Math.PI) % (2 * Math.PI);
    const direction = Math.floor((bearing / (2 * Math.PI)) * DIRECTIONS);
    const sample = Math.floor((Math.hypot(x - ox, y - oy) / RANGE) * SAMPLES);
    let strength = '';
    let swept = '';
    for (let k = 0; k < WIDE; k++) {
      swept += seen(part * WIDE + k) ? 'B' : 'A';
      for (let s = 0; s < SAMPLES; s++) {
        const hit = part * WIDE + k === direction && Math.abs(s - sample) < 1;
        strength += hit ? 'P' : 'A';
      }
    }
    takeSpokes(state, {
      part,
      parts: PARTS,
      directions: DIRECTIONS,
      samples: SAMPLES,
      range: RANGE,
      at,
      x: ox,
      y: oy,
      seen: swept,
      strength,
    });
  }
}

test('a pier stays under its pixel in every orientation', () => {
  const state = emptyState();
  const [x, y] = [1234, -987];
  turn(state, x, y, () => [0, 0]);
  for (const heading of [0, 37, 90, 180, 359.6]) {
    const view = {
      originX: 0,
      originY: 0,
      centreX: 400,
      centreY: 300,
      scale: 0.11,
      up: radians(heading),
    };
    const back = toMap(view, ...toScreen(view, x, y));
    assert.equal(strengthAt(state.spokes, ...back, 10), 1);
    const beside = toMap(view, ...toScreen(view, x + 160, y));
    assert.equal(strengthAt(state.spokes, ...beside, 10), 0);
  }
});

test('own ship makes way while the beam turns: each direction counts from where she was', () => {
  const state = emptyState();
  const [x, y] = [-1500, 1100];
  turn(state, x, y, (part) => [30 * part, -20 * part]);
  assert.equal(strengthAt(state.spokes, x, y, 10), 1);
});

test('echoes fade with age, and what was not swept is empty', () => {
  const state = emptyState();
  turn(
    state,
    800,
    600,
    () => [0, 0],
    10,
    (direction) => direction % 2 === 1,
  );
  const values = [10, 12, 14, 30].map((now) => strengthAt(state.spokes, 800, 600, now));
  const swept = Math.floor((Math.atan2(800, 600) / (2 * Math.PI)) * DIRECTIONS) % 2 === 1;
  if (!swept) assert.deepEqual(values, [0, 0, 0, 0]);
  else assert.ok(values[0] > values[1] && values[1] > values[2] && values[3] === 0);
});

test('beyond the last sample there is nothing, and a shorter range leaves no ring', () => {
  const state = emptyState();
  turn(state, 0, 3000, () => [0, 0]);
  assert.equal(strengthAt(state.spokes, 0, 3000, 10), 1);
  for (const part of state.spokes.held) part.range = 1500;
  assert.equal(strengthAt(state.spokes, 0, 3000, 10), 0);
});

test('spokes come as messages of their own, part by part', () => {
  const state = emptyState();
  receive(
    state,
    {
      kind: 'spokes',
      now: 5,
      part: 3,
      parts: 4,
      directions: 8,
      samples: 2,
      range: 100,
      at: 5,
      x: 0,
      y: 0,
      seen: 'BB',
      strength: 'APPA',
    },
    1,
  );
  assert.equal(state.spokes.count, 1);
  assert.deepEqual([...state.spokes.held[3].strength], [0, 15, 15, 0]);
});
