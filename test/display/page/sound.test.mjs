// When alarms sound.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const { Sound } = await import(
  new URL('../../../marine_tracker/display/static/sound.js', import.meta.url)
);

/** A sound that tells what it plays instead of playing it. */
function heard() {
  const sound = new Sound();
  sound.told = [];
  sound.play = function (priority, now) {
    this.last = now;
    this.told.push([priority, now]);
  };
  return sound;
}

const alert = (name, priority, state = 'active unacknowledged') => ({ name, priority, state });

test('an alarm sounds at once, and each 7 s until it is acknowledged', () => {
  const sound = heard();
  for (let now = 100; now < 118; now++) sound.update([alert('TT05: danger', 'alarm')], now);
  assert.deepEqual(sound.told, [
    ['alarm', 100],
    ['alarm', 107],
    ['alarm', 114],
  ]);
  sound.update([alert('TT05: danger', 'alarm', 'active acknowledged')], 130);
  sound.update([alert('TT05: danger', 'alarm', 'rectified unacknowledged')], 150);
  assert.equal(sound.told.length, 3);
});

test('a warning sounds once, a caution never', () => {
  const sound = heard();
  const alerts = [alert('lost', 'warning'), alert('swap', 'caution')];
  for (let now = 5; now < 60; now++) sound.update(alerts, now);
  assert.deepEqual(sound.told, [['warning', 5]]);
});

test('a warning that sounds again by the tracker, and an alarm whose silence has ended, are heard', () => {
  const sound = heard();
  const one = alert('lost', 'warning');
  sound.update([{ ...one, instance: 3, sounds: 1 }], 1);
  sound.update([{ ...one, instance: 3, sounds: 1 }], 200);
  sound.update([{ ...one, instance: 3, sounds: 2 }], 301);
  assert.deepEqual(sound.told, [
    ['warning', 1],
    ['warning', 301],
  ]);
  const danger = { ...alert('TT08: danger', 'alarm'), instance: 5 };
  sound.update([{ ...danger, sounds: 1 }], 400);
  sound.update([{ ...danger, sounds: 1, state: 'active silenced' }], 402);
  sound.update([{ ...danger, sounds: 1, state: 'active silenced' }], 420);
  sound.update([{ ...danger, sounds: 2 }], 432);
  assert.deepEqual(sound.told.slice(2), [
    ['alarm', 400],
    ['alarm', 432],
  ]);
});

test('this device silenced for 30 s, but not for a new alarm', () => {
  const sound = heard();
  const first = alert('TT05: danger', 'alarm');
  sound.update([first], 10);
  sound.silence(11);
  for (let now = 12; now < 41; now++) sound.update([first], now);
  assert.equal(sound.told.length, 1);
  sound.update([first], 41);
  assert.deepEqual(sound.told.at(-1), ['alarm', 41]);
  sound.silence(42);
  sound.update([first, alert('TT09: danger', 'alarm')], 43);
  assert.deepEqual(sound.told.at(-1), ['alarm', 43]);
});
