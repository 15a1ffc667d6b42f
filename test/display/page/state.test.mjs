// Ages, staleness and what numbers look like.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const page = new URL('../../../marine_tracker/display/static/', import.meta.url);
const { emptyState, receive, reconnected, serverNow, staleness } = await import(
  new URL('state.js', page)
);
const format = await import(new URL('format.js', page));
const { placed } = await import(new URL('labels.js', page));

const SERVER = 50_000; // s, of its steady clock, when this browser's shows 0
const none = { number: [], id: [] };

/** A state that heard own ship and a scan at `local` s. */
function live(local, period = 2.5) {
  const state = emptyState();
  const now = SERVER + local;
  receive(state, { kind: 'own', now, at: now, x: 0, y: 0, vx: 0, vy: 0, heading: 1 }, local);
  receive(state, { kind: 'targets', now, at: now, time: 9, period, columns: none }, local);
  return state;
}

test('a live picture is live, and stale 3 s after the last word', () => {
  const state = live(20);
  assert.equal(staleness(state, 20.1), '');
  assert.equal(staleness(state, 22.9), '');
  assert.match(staleness(state, 23.1), /No connection for 3 s/);
});

test('a server that still talks does not make old data young', () => {
  const state = live(20);
  for (let local = 21; local < 24; local++)
    receive(state, { kind: 'pulse', now: SERVER + local }, local);
  assert.match(staleness(state, 23.5), /No own ship for 3 s/);
});

test('a ship at rest is not stale, a tracker without scans is once the next is 3 s overdue', () => {
  const state = live(20, 4);
  for (let local = 21; local < 40; local += 0.5) {
    const now = SERVER + local;
    receive(state, { kind: 'own', now, at: now, x: 0, y: 0, vx: 0, vy: 0, heading: 1 }, local);
    assert.equal(staleness(state, local).startsWith('No scan'), local >= 27, String(local));
  }
});

test('before the first data the picture is not live either', () => {
  const state = emptyState();
  assert.match(staleness(state, 5), /No connection yet/);
  receive(state, { kind: 'pulse', now: 1 }, 5);
  assert.match(staleness(state, 5.5), /No own ship yet/);
});

test('messages that were long on their way do not change the time, and a new server does', () => {
  const state = live(20);
  receive(state, { kind: 'pulse', now: SERVER + 20.2 }, 22.2); // 2 s late
  assert.ok(Math.abs(serverNow(state, 23) - (SERVER + 23)) < 0.001); // clocks may drift a little
  reconnected(state);
  receive(state, { kind: 'pulse', now: 7 }, 24);
  assert.ok(Math.abs(serverNow(state, 25) - 8) < 1e-9);
});

test('a network that gets slower and slower makes no picture young, however long it lasts', () => {
  const state = live(20);
  let stale = 0;
  for (let sent = 20; sent < 140; sent += 0.1) {
    const local = sent + 0.1 * (sent - 20); // 12 s behind at the end
    const now = SERVER + sent;
    receive(state, { kind: 'own', now, at: now, x: 0, y: 0, vx: 0, vy: 0, heading: 1 }, local);
    receive(state, { kind: 'targets', now, at: now, time: 9, period: 2, columns: none }, local);
    stale = staleness(state, local) ? stale || local - sent : 0;
  }
  assert.ok(Math.abs(stale - 3) < 0.2, `stale at ${stale} s`);
  assert.ok(Math.abs(state.late - 12) < 0.1);
  assert.match(staleness(state, 152), /network is 11 s late/);
});

test('what waited in a network that was dead comes late, and is not taken for live', () => {
  const state = live(20);
  for (let sent = 20; sent < 95; sent += 0.1) {
    const now = SERVER + sent;
    receive(state, { kind: 'own', now, at: now, x: 0, y: 0, vx: 0, vy: 0, heading: 1 }, 95);
    receive(state, { kind: 'targets', now, at: now, time: 9, period: 2, columns: none }, 95);
    const boundary = Math.abs(sent - 92) < 0.05;
    if (!boundary) assert.equal(staleness(state, 95) === '', sent > 92, `sent at ${sent}`);
  }
});

test('clocks that drift against each other are followed', () => {
  const state = live(0);
  for (let local = 1; local < 7200; local++) {
    const now = SERVER + local * (1 - 5e-5); // 0.36 s in two hours
    receive(state, { kind: 'pulse', now, at: now }, local);
  }
  assert.ok(state.late < 0.01);
});

test('plots of another run push those of the last one out', () => {
  const state = emptyState();
  for (const stamp of [100, 103, 106, 2]) {
    receive(state, { kind: 'plots', now: 1, at: 1, stamp, x: [], y: [] }, 1);
  }
  assert.deepEqual(
    state.plots.map((scan) => scan.stamp),
    [2],
  );
  for (let stamp = 3; stamp < 60; stamp++)
    receive(state, { kind: 'plots', now: 1, at: 1, stamp }, 1);
  assert.ok(state.plots.length < 20);
});

test('of a radar that sends sectors as many scans are kept as of one that does not', () => {
  const state = emptyState();
  receive(state, { kind: 'targets', now: 1, at: 1, time: 9, period: 2.5, columns: none }, 1);
  for (let k = 0; k < 600; k++) {
    receive(state, { kind: 'plots', now: 1, at: 1, stamp: (k * 2.5) / 16 }, 1);
  }
  assert.equal(state.plots.length, 12 * 16);
});

test('what is not known is a dash, and north is north', () => {
  for (const show of [format.bearing, format.miles, format.knots, format.minutes]) {
    for (const nothing of [null, undefined, NaN, Infinity])
      assert.equal(show(nothing), format.NONE);
  }
  assert.equal(format.bearing(0), '000.0');
  assert.equal(format.bearing(2 * Math.PI - 1e-5), '000.0');
  assert.equal(format.bearing(-Math.PI / 2), '270.0');
  assert.equal(format.knots(0), '0.0');
  assert.equal(format.miles(926), '0.50');
  assert.equal(format.place(-33.99999999, 8.5), '34°00.000′S 008°30.000′E');
  assert.equal(format.place(null, 8), format.NONE);
});

test('labels do not lie over each other, and those needed are never left out', () => {
  const labels = Array.from({ length: 60 }, (_, k) => ({
    x: 300 + (k % 8),
    y: 200 + (k % 5),
    text: String(k),
    needed: k % 20 === 0,
  }));
  const found = placed(labels, () => 16);
  assert.equal(found.filter(({ label }) => label.needed).length, 3);
  const boxes = found.filter(({ label }) => !label.needed);
  for (const a of boxes) {
    for (const b of found) {
      const apart = Math.abs(a.left - b.left) > 16 || Math.abs(a.middle - b.middle) > 14;
      assert.ok(a === b || apart);
    }
  }
});
