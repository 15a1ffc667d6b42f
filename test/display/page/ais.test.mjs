import assert from 'node:assert/strict';
import { test } from 'node:test';

import { direction, drawShips, flagOf } from '../../../marine_tracker/display/static/ais.js';
import {
  joinedSays,
  settingsSay,
  wordsOf,
} from '../../../marine_tracker/display/static/ship_words.js';
import {
  alarmOf,
  byTrack,
  readShips,
  selection,
  shipsShown,
} from '../../../marine_tracker/display/static/ships.js';
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

const WORDS = { kinds: ['class A', 'class B'], statuses: ['under way using engine', 'at anchor'] };

/** A ship as the page has her, of what a message tells. */
const ship = (given) =>
  readShips(
    [
      {
        ...{ id: 31, mmsi: 219000001, track: 0, kind: 0, state: 1, shown: 0, danger: 0, lost: 0 },
        ...{ x: 100, y: 200, vx: 0, vy: 5, heading: 0.5, course: 0, speed: 5, turn: 0, cpa: 900 },
        ...{ name: 'SKAGEN', call_sign: 'OXYZ', nav: 0, length: 90, beam: 15, age: 4 },
        ...{ probability: 0, accurate: 1, coarse: 0, double: 0 },
        ...given,
      },
    ],
    WORDS,
  )[0];

const view = { originX: 0, originY: 0, centreX: 300, centreY: 300, scale: 0.1, up: 0 };
const settings = { labels: 'on', ships: 'all', vectors: 'true', vectorMinutes: 6 };
const colors = { target: 'green', danger: 'red', selected: 'white' };
const OWN = { x: 0, y: 0, vx: 0, vy: 0, wx: 0, wy: 0, latitude: 55.5, longitude: 11.25 };

const stateOf = (...ships) => ({ ...emptyState(), ships, own: OWN });

function drawn(...ships) {
  const canvas = pen();
  const labels = drawShips(canvas, stateOf(...ships), settings, { view }, colors, null, 0);
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
  const unknown = drawn(ship({ heading: null, speed: null, course: null, cpa: null })).calls;
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
  const state = { ...stateOf(ship({ danger: 2 })), alarms };
  const canvas = pen();
  drawShips(canvas, state, settings, { view }, colors, null, 0.6);
  assert.equal(canvas.calls.length, 0);
  drawShips(canvas, state, settings, { view }, colors, null, 1.1);
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

test('a vector of a ship is relative where those of targets are', () => {
  const moved = (vectors) => {
    const canvas = pen();
    const own = { ...OWN, wx: 3, wy: 5 };
    const state = { ...stateOf(ship({ heading: null, vx: 9, vy: 9 })), own };
    drawShips(canvas, state, { ...settings, vectors }, { view }, colors, null, 0);
    return canvas.calls.filter(([name]) => name === 'lineTo').at(-1);
  };
  // 310, 280 is her place; 5 m/s north in 360 s are 180 px up; own ship's 3 m/s east 108 px to port.
  assert.deepEqual(moved('true').slice(1), [310, 100]);
  assert.deepEqual(moved('relative').slice(1), [202, 280]);
});

test('an outline to scale shows once it is longer than a symbol, about her middle', () => {
  const near = { ...view, scale: 0.5 }; // 90 m are 45 px
  const lines = (at, given) => {
    const canvas = pen();
    drawShips(canvas, stateOf(ship(given)), settings, { view: at }, colors, null, 0);
    return canvas.calls.filter(([name, , y]) => name === 'moveTo' && y === -45).length;
  };
  assert.equal(lines(near), 1);
  assert.equal(lines(view), 0);
  for (const unknown of [{ heading: null }, { beam: null }, { length: null }, { lost: 1 }])
    assert.equal(lines(near, unknown), 0);
});

test('the filter leaves out who is asleep, never who is dangerous, lies or is in distress', () => {
  const ships = [
    ship({ id: 1, shown: 0 }),
    ship({ id: 2, shown: 1 }),
    ship({ id: 3, shown: 1, danger: 2 }),
    ship({ id: 4, shown: 1, state: 3 }),
    ship({ id: 5, shown: 1, kind: 4 }),
    ship({ id: 6, shown: 0, state: 2, track: 8 }),
  ];
  const left = (asked) => shipsShown(stateOf(...ships), { ships: asked }).map(({ id }) => -id);
  assert.deepEqual(left('all'), [1, 2, 3, 4, 5]);
  assert.deepEqual(left('activated'), [1, 3, 4, 5]);
  assert.deepEqual(left('off'), [3, 4, 5]);
});

test('a lost ship stays until it is acknowledged; one that slept just goes', () => {
  const state = stateOf(ship({ id: 1, lost: 1 }), ship({ id: 2, mmsi: 5, lost: 1, shown: 1 }));
  const shown = (told) => {
    state.alarms = told ? [{ kind: 'AIS lost', mmsi: 219000001, state: told }] : [];
    return shipsShown(state, settings).map(({ id }) => -id);
  };
  assert.deepEqual(shown('active unacknowledged'), [1]);
  assert.deepEqual(shown('active acknowledged'), []);
  assert.deepEqual(shown(''), [1], 'the alarm is off, or she is too far away for it');
});

test('what is selected is a target, a ship, or both; a ship keeps it when she is joined', () => {
  const alone = ship({ id: 40 });
  const state = { ...stateOf(alone, ship({ id: 41, state: 2, track: 7 })), targets: [{ id: 7 }] };
  assert.equal(selection(state, -40).ship, alone);
  assert.equal(selection(state, -40).target, undefined);
  assert.equal(selection(state, 7).ship.id, -41);
  Object.assign(alone, { state: 2, track: 9 });
  state.targets.push({ id: 9 });
  assert.equal(selection(state, -40).id, 9);
  assert.equal(selection(state, 3).target, undefined);
  assert.equal(selection(state, null).id, null);
});

test('a ship tells in words, what she does not tell is missing, 0 is a value', () => {
  const words = (given) => Object.fromEntries(wordsOf(ship(given), OWN));
  const all = words({ turn: -0.01, vx: 3, vy: -4, mmsi: 2190001, heading: 0 });
  assert.equal(all.Name, 'SKAGEN');
  assert.equal(all.MMSI, '002190001');
  assert.equal(all.Status, 'under way using engine');
  assert.equal(all['COG, SOG'], '143.1°, 9.7 kn');
  assert.equal(all['HDG, ROT'], '000.0°, -34°/min');
  assert.equal(all.Size, '90 × 15 m');
  assert.match(all.Position, /^55°30.108′N 011°15.095′E$/);
  const little = { name: '', call_sign: '', nav: null, heading: null, turn: null, length: null };
  const none = words({ ...little, vx: null, vy: null, coarse: 1, lost: 1, age: 400, double: 1 });
  for (const term of ['Name', 'Call sign', 'Status', 'Size']) assert.equal(none[term], 'missing');
  assert.equal(none['COG, SOG'], 'missing, missing');
  assert.equal(none['HDG, ROT'], 'missing, missing');
  assert.match(none.Report, /LOST/);
  assert.match(none.MMSI, /TWO SHIPS/);
  const rests = words({ vx: 0, vy: 0 });
  assert.equal(rests['COG, SOG'], 'missing, 0.0 kn');
});

test('how far a ship is joined stands in words', () => {
  assert.equal(joinedSays(ship({ state: 2, probability: 0.987 })), 'joined, 99 %');
  assert.equal(joinedSays(ship({ state: 0, probability: 0.31 })), 'not joined; likely at 31 %');
  assert.equal(joinedSays(ship({ state: 0, probability: 0 })), 'not joined');
  assert.match(joinedSays(ship({ state: 3, probability: 0 })), /MISMATCH/);
});

test('all that decides what of AIS shows and alarms stands in words', () => {
  const ais = {
    ...{ ais_symbol: 'radar', ais_join: true, ais_kinds: 'a aid', ais_range_nm: 17, ais_cpa_nm: 3 },
    ...{ ais_activation: 'danger range', ais_activation_range_nm: 4, ais_sleeping_danger: false },
    ...{ ais_lost_alarm: true, ais_lost_range_nm: 5 },
  };
  const said = settingsSay({ ...emptyState(), ais }, { ships: 'activated' });
  for (const part of [
    'activated only',
    'sleeping to 17 NM and CPA 3 NM, of a aid',
    'activated by danger range 4 NM',
    'CPA alarm of activated',
    'lost alarm to 5 NM',
    'joined shown as radar',
  ])
    assert.ok(said.includes(part), `${part} in: ${said}`);
  const off = {
    ...ais,
    ais_lost_alarm: false,
    ais_join: false,
    ais_activation: '',
    ais_cpa_nm: 200,
  };
  const other = settingsSay({ ...emptyState(), ais: off }, { ships: 'off' });
  for (const part of ['OFF;', 'LOST ALARM OFF', 'NOT JOINED', 'by hand only'])
    assert.ok(other.includes(part), `${part} in: ${other}`);
  assert.ok(!other.includes('CPA 200'));
});
