// Labels: none over another, and none of those that are needed is left out.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const page = new URL('../../../marine_tracker/display/static/', import.meta.url);
const { placed } = await import(new URL('labels.js', page));

const widthOf = (text) => 8 * text.length;
const overlap = (a, b) =>
  a.left <= b.left + widthOf(b.label.text) &&
  b.left <= a.left + widthOf(a.label.text) &&
  Math.abs(a.middle - b.middle) <= 14;
const crowd = (count, needed) =>
  Array.from({ length: count }, (_, k) => ({
    x: 300 + 3 * (k % 5),
    y: 200 + 4 * Math.floor(k / 5),
    text: String(k).padStart(2, '0'),
    needed: needed(k),
  }));

test('in a crowd no label stands over another', () => {
  const found = placed(
    crowd(60, () => false),
    widthOf,
  );
  assert.ok(found.length >= 3 && found.length < 60);
  found.forEach((a, k) => found.slice(k + 1).forEach((b) => assert.ok(!overlap(a, b))));
  assert.ok(found.every(({ far }) => !far));
});

test('of twenty dangerous ones in one place all are shown, none over another, with their lines', () => {
  const found = placed(
    crowd(45, (k) => k % 9 < 4),
    widthOf,
  );
  const needed = found.filter(({ label }) => label.needed);
  assert.equal(needed.length, 20);
  found.forEach((a, k) => found.slice(k + 1).forEach((b) => assert.ok(!overlap(a, b))));
  assert.ok(needed.some(({ far }) => far));
});

test('a lone label stands right above its target', () => {
  const [only] = placed([{ x: 50, y: 90, text: '07', needed: false }], widthOf);
  assert.deepEqual([only.left, only.middle, only.far], [61, 79, false]);
});
