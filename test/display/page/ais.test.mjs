import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
  alarmOf,
  byTrack,
  direction,
  drawShips,
  flagOf,
} from '../../../marine_tracker/display/static/ais.js';
import { emptyState, receive } from '../../../marine_tracker/display/static/state.js';
import * as symbols from '../../../marine_tracker/display/static/symbols.js';

/** A canvas that notes what is drawn: the points, turned and moved as it is told. */
function pen() {
  const calls = [];
  return new Proxy(
    { calls },
    {
      get: (target, name) =>
        name === 'calls' ? calls : (...given) => calls.push([String(name), ...given]),
      set: (target, name, value) => calls.push([`= ${String(name)}`, value]) > 0,
    },
  );
}

const ship = (given) => ({
  ...{ mmsi: 219000001, track: 0, kind: 0, state: 1, shown: 0, danger: 0, lost: 0 },
  ...{ x: 100, y: 200, vx: 0, vy: 5, heading: 0.5, course: 0, turn: 0, cpa: 900, name: 'SKAGEN' },
  ...given,
});

const view = { originX: 0, originY: 0, centreX: 300, centreY: 300, scale: 0.1, up: 0 };
const settings = { labels: 'on', vectors: 'absolute', vectorMinutes: 6 };
const colors = { target: 'green', danger: 'red' };

function drawn(...ships) {
  const canvas = pen();
  const state = { ...emptyState(), ships, own: { vx: 0, vy: 0 } };
  const labels = drawShips(canvas, state, settings, { view }, colors, 0);
  return { calls: canvas.calls, labels };
}

test('a triangle points along the heading, else the course, else up; north is north', () => {
  assert.equal(direction(ship({ heading: 0, course: 2 })), 0);
  assert.equal(direction(ship({ heading: null, course: 2 })), 2);
  assert.equal(direction(ship({ heading: null, course: null }), 0.7), 0.7);
});

test('a sleeping ship is a small triangle without vector, an activated one has heading line', () => {
  const asleep = drawn(ship({ shown: 1 })).calls;
  const awake = drawn(ship({ shown: 0 })).calls;
  const apex = (calls) => calls.find(([name]) => name === 'moveTo')[2];
  assert.ok(apex(asleep) > apex(awake), 'smaller');
  const lines = (calls) => calls.filter(([name]) => name === 'stroke').length;
  assert.equal(lines(asleep), 1);
  assert.equal(lines(awake), 3);
});

test('no heading, no heading line; no speed, no vector; unknown CPA, a broken outline', () => {
  const unknown = drawn(ship({ heading: null, vx: null, vy: null, cpa: null })).calls;
  assert.equal(unknown.filter(([name]) => name === 'stroke').length, 1);
  assert.ok(unknown.some(([name, dash]) => name === 'setLineDash' && dash.length === 2));
});

test('a turn has a flag to its side, a slow one none', () => {
  assert.equal(flagOf(ship({ turn: 0.02 })), 1);
  assert.equal(flagOf(ship({ turn: -0.02 })), -1);
  assert.equal(flagOf(ship({ turn: 0.0001 })), 0);
  assert.equal(flagOf(ship({ turn: null })), 0);
});

test('a joined ship is drawn with her target, one symbol for both', () => {
  const joined = ship({ state: 2, track: 17 });
  assert.equal(drawn(joined).calls.length, 0);
  assert.equal(byTrack([joined, ship({ state: 3, track: 18 })]).size, 1);
  assert.equal(byTrack([joined]).get(17), joined);
});

test('a lost ship has a bold cross and no vector, a mismatch its name with a question mark', () => {
  const lost = drawn(ship({ lost: 1 })).calls;
  assert.equal(lost.filter(([name]) => name === 'stroke').length, 2);
  assert.ok(lost.some(([name, value]) => name === '= strokeStyle' && value === 'red'));
  const [label] = drawn(ship({ state: 3, name: '' })).labels;
  assert.equal(label.text, '219000001 ?');
  assert.ok(label.needed);
});

test('a beacon is a circle with a cross, an aid to navigation a diamond', () => {
  const beacon = drawn(ship({ kind: 4 })).calls;
  assert.ok(beacon.some(([name]) => name === 'arc'));
  const aid = drawn(ship({ kind: 3 })).calls;
  assert.ok(!aid.some(([name]) => name === 'arc'));
  assert.ok(aid.some(([name]) => name === 'closePath'));
});

test('an alert of a ship flashes until it is acknowledged', () => {
  const alarms = [{ kind: 'AIS danger', mmsi: 219000001, state: 'active unacknowledged' }];
  assert.equal(alarmOf(alarms, 'AIS danger', 219000001), 'active unacknowledged');
  assert.equal(alarmOf(alarms, 'AIS lost', 219000001), '');
  const state = { ...emptyState(), ships: [ship({ danger: 2 })], alarms, own: { vx: 0, vy: 0 } };
  const canvas = pen();
  drawShips(canvas, state, settings, { view }, colors, 0.6);
  assert.equal(canvas.calls.length, 0);
  drawShips(canvas, state, settings, { view }, colors, 1.1);
  assert.ok(canvas.calls.length > 0);
});

test('ships come as columns and become rows', () => {
  const state = emptyState();
  const columns = { mmsi: [219000001, 5], x: [1, null], name: ['A', ''] };
  receive(state, { kind: 'ships', now: 0, at: 0, columns }, 0);
  assert.deepEqual(
    state.ships.map((one) => one.mmsi),
    [219000001, 5],
  );
  assert.equal(state.ships[1].x, null);
});

test('the triangle of the standard is acute and about her place', () => {
  const canvas = pen();
  symbols.triangle(canvas, 0, 0, 0, 'green', {});
  const points = canvas.calls.filter(([name]) => name.endsWith('To')).map(([, x, y]) => [x, y]);
  const [apex, right, left] = points;
  assert.equal(apex[1], -right[1]);
  assert.equal(right[0], -left[0]);
  assert.ok(right[1] - apex[1] > right[0] - left[0], 'higher than wide');
});
