// When the picture is drawn.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const page = new URL('../../../marine_tracker/display/static/', import.meta.url);
const { Pace } = await import(new URL('pace.js', page));

/** Frames for so many ms on a machine that needs `cost` ms to draw; how often it drew. */
function run(pace, cost, length, before = () => {}) {
  let drawn = 0;
  for (let now = 1000; now < 1000 + length; ) {
    before(now);
    const due = pace.due(now);
    drawn += due;
    now += Math.max(due ? cost : 0, 16);
  }
  return drawn;
}

test('news are drawn at once where drawing is cheap, and take a third of the time where it is not', () => {
  const quick = run(new Pace(), 5, 6000, () => {});
  assert.ok(quick >= 22 && quick <= 27, `${quick}`); // four times a second without any news
  const fed = new Pace();
  assert.ok(run(fed, 5, 6000, () => fed.news()) > 350);
  const slow = new Pace();
  const drawn = run(slow, 130, 13000, () => slow.news());
  assert.ok(drawn >= 26 && drawn <= 60, `${drawn}`);
});

test('whoever does something waits for no news', () => {
  const pace = new Pace();
  run(pace, 130, 5000, () => pace.news());
  const now = pace.last + 16;
  assert.equal(pace.due(now), false);
  pace.ask();
  assert.equal(pace.due(now + 16), true);
});
