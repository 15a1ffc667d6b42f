// What is drawn and what is clicked are at one place, in every orientation, at every ratio.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const page = new URL('../../../marine_tracker/display/static/', import.meta.url);
const geometry = await import(new URL('geometry.js', page));
const { targetAt } = await import(new URL('picture.js', page));
const { scopeOf } = await import(new URL('scope.js', page));
const held = (courseUp, anchor = null) => ({ courseUp, anchor });
const { NAUTICAL_MILE, radians, degrees, wrap, toScreen, toMap, rangeBearing, edge } = geometry;

const HEADINGS = [0, 37, 90, 143.5, 180, 271, 359.6];
const own = (heading) => ({ x: 41234.5, y: -7020.25, vx: 3, vy: 4, heading });
const settings = (more) => ({
  range: 5,
  motion: 'relative',
  orientation: 'north-up',
  offCentre: 'off',
  ...more,
});
const near = (a, b, within) => assert.ok(Math.abs(a - b) <= within, `${a} is not ${b}`);

for (const orientation of ['north-up', 'head-up', 'course-up']) {
  for (const offCentre of ['off', 'ahead', 'place']) {
    test(`pixel to map and back, ${orientation}, off-centre ${offCentre}`, () => {
      for (const heading of HEADINGS) {
        for (const [width, height] of [
          [813, 640],
          [1220, 960],
          [1626, 1280],
        ]) {
          const state = { own: own(radians(heading)) };
          const { view } = scopeOf(
            state,
            settings({ orientation, offCentre, offRight: -0.42, offDown: 0.31 }),
            width,
            height,
            held(radians(211)),
          );
          for (const [px, py] of [
            [12, 700],
            [400.5, 3.25],
            [view.centreX, view.centreY],
          ]) {
            const back = toScreen(view, ...toMap(view, px, py));
            near(back[0], px, 1e-6);
            near(back[1], py, 1e-6);
          }
        }
      }
    });
  }
}

test('north-up has a target on 045 up and to the right, head-up one on the heading straight up', () => {
  const state = { own: own(radians(127)) };
  const place = (bearing) => [
    state.own.x + 1500 * Math.sin(radians(bearing)),
    state.own.y + 1500 * Math.cos(radians(bearing)),
  ];
  let scope = scopeOf(state, settings({}), 800, 800, held(0));
  let [x, y] = toScreen(scope.view, ...place(45));
  near(x - 400, 400 - y, 1e-6);
  assert.ok(x > 450);
  scope = scopeOf(state, settings({ orientation: 'head-up' }), 800, 800, held(0));
  [x, y] = toScreen(scope.view, ...place(127));
  near(x, 400, 1e-6);
  near(400 - y, (1500 / (3 * NAUTICAL_MILE)) * scope.radius, 1e-6);
  [x, y] = toScreen(scope.view, ...place(217)); // to starboard
  near(y, 400, 1e-6);
  assert.ok(x > 450);
});

test('a click on the screen has the range and bearing of what is drawn there', () => {
  for (const heading of HEADINGS) {
    const state = { own: own(radians(heading)) };
    const { view } = scopeOf(state, settings({ orientation: 'head-up' }), 700, 700, held(0));
    for (const bearing of [0.4, 88, 179.5, 260, 345]) {
      const away = 2345;
      const [px, py] = toScreen(
        view,
        state.own.x + away * Math.sin(radians(bearing)),
        state.own.y + away * Math.cos(radians(bearing)),
      );
      const found = rangeBearing(state.own.x, state.own.y, ...toMap(view, px, py));
      near(found[0], away, 1e-6);
      near(degrees(found[1]), bearing, 1e-9);
    }
  }
});

test('a yawing ship leaves a pier where it is, in all orientations but head-up itself turning', () => {
  const pier = [43000, -6100];
  for (const orientation of ['north-up', 'course-up']) {
    const places = [-20, -7, 0, 11, 20].map((yaw) => {
      const state = { own: own(radians(80 + yaw)) };
      return toScreen(
        scopeOf(state, settings({ orientation }), 900, 700, held(radians(80))).view,
        ...pier,
      );
    });
    for (const [x, y] of places) {
      near(x, places[2][0], 1e-9);
      near(y, places[2][1], 1e-9);
    }
  }
});

test('without a heading the picture is head-up by the last one, and north is not known', () => {
  for (const orientation of ['north-up', 'course-up', 'head-up']) {
    const lost = { ...own(null), bow: radians(61) };
    const asked = settings({ orientation, offCentre: 'ahead', motion: 'true' });
    const scope = scopeOf({ own: lost }, asked, 500, 500, held(1, [0, 0]));
    assert.equal(scope.orientation, 'head-up');
    assert.equal(scope.motion, 'relative');
    assert.equal(scope.north, false);
    assert.equal(scope.view.up, radians(61));
    near(scope.view.centreX, 250, 1e-9);
    near(scope.view.centreY, 250 + 0.5 * scope.radius, 1e-9);
  }
});

test('the nearest target within reach is the one that is clicked', () => {
  const state = {
    own: own(radians(200)),
    targets: [
      { id: 5, x: 41234.5 + 500, y: -7020.25, status: 1 },
      { id: 6, x: 41234.5 + 560, y: -7020.25, status: 1 },
      { id: 7, x: null, y: null, status: 0 },
      { id: 8, x: 41234.5 + 505, y: -7020.25, status: 3 },
    ],
    ships: [],
  };
  const { view } = scopeOf(
    state,
    settings({ orientation: 'course-up' }),
    600,
    600,
    held(radians(200)),
  );
  assert.equal(
    targetAt(state, settings({}), view, ...toScreen(view, 41234.5 + 515, -7020.25)).id,
    5,
  );
  assert.equal(
    targetAt(state, settings({}), view, ...toScreen(view, 41234.5 + 552, -7020.25)).id,
    6,
  );
  assert.equal(
    targetAt(state, settings({}), view, ...toScreen(view, 41234.5 - 2000, -7020.25)),
    null,
  );
});

test('the edge of the circle is met on its bearing, off-centre too', () => {
  const state = { own: own(radians(300)) };
  const scope = scopeOf(state, settings({ offCentre: 'ahead' }), 640, 640, held(0));
  for (const bearing of [0, 61, 175, 300]) {
    const [x, y] = edge(scope.view, radians(bearing), scope.middleX, scope.middleY, scope.radius);
    near(Math.hypot(x - scope.middleX, y - scope.middleY), scope.radius, 1e-9);
    const [, found] = rangeBearing(state.own.x, state.own.y, ...toMap(scope.view, x, y));
    near(degrees(found), bearing, 1e-9);
  }
});

test('an uncertainty ellipse has the axes of its covariance', () => {
  // 30 m along 060, 10 m across.
  const [sin, cos] = [Math.sin(radians(60)), Math.cos(radians(60))];
  const xx = 900 * sin * sin + 100 * cos * cos;
  const yy = 900 * cos * cos + 100 * sin * sin;
  const xy = 800 * sin * cos;
  const found = geometry.ellipse(xx, xy, yy);
  near(found.long, 30, 1e-9);
  near(found.short, 10, 1e-9);
  near(degrees(found.bearing) % 180, 60, 1e-9);
});

test('bearings wrap once and never to 360', () => {
  for (const angle of [-1e-17, 0, 2 * Math.PI, -7, 900]) {
    assert.ok(wrap(angle) >= 0 && wrap(angle) < 2 * Math.PI);
  }
});
