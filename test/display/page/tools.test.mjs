// Bearing lines, range markers, index lines, the measure, true motion, places on Earth.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const page = new URL('../../../marine_tracker/display/static/', import.meta.url);
const geometry = await import(new URL('geometry.js', page));
const scope = await import(new URL('scope.js', page));
const { RANGES, CHOICES } = await import(new URL('settings.js', page));
const tools = await import(new URL('tools.js', page));
const { placeAt } = await import(new URL('geodesic.js', page));
const { cursorLines, radars } = await import(new URL('corners.js', page));
const { NAUTICAL_MILE, degrees, direction, radians, rangeBearing, toScreen } = geometry;

const near = (a, b, within = 1e-6) => assert.ok(Math.abs(a - b) <= within, `${a} is not ${b}`);
const own = (more) => ({ x: -3300, y: 1250, vx: 2, vy: 5, heading: radians(37), ...more });
const settings = (more) => ({
  range: RANGES.findIndex(([range]) => range === 3),
  orientation: 'north-up',
  motion: 'relative',
  offCentre: 'off',
  offRight: 0,
  offDown: 0,
  ...more,
});
const polar = (from, range, bearing) => [
  from.x + range * Math.sin(radians(bearing)),
  from.y + range * Math.cos(radians(bearing)),
];

test('ranges go from .125 to 96 NM, each with even rings that end at its edge', () => {
  assert.deepEqual([RANGES[0][0], RANGES[RANGES.length - 1][0]], [0.125, 96]);
  for (const [range, ring] of RANGES) {
    near(range / ring, Math.round(range / ring), 1e-9);
    assert.ok(range / ring >= 3 && range / ring <= 6);
  }
  assert.deepEqual([CHOICES.trailMinutes[0], CHOICES.trailMinutes.at(-1)], [0.25, 30]);
});

// -- EBL, VRM --------------------------------------------------------------------------------

test('the first two marks are EBL and VRM through the cursor, the third takes both away', () => {
  const ship = own();
  const set = tools.newTools();
  tools.markNext(set, polar(ship, 2100, 283), ship);
  tools.markNext(set, polar(ship, 900, 4.5), ship);
  assert.deepEqual(tools.readouts(set, ship), [
    'EBL1 283.0° T',
    'EBL2 004.5° T',
    'VRM1 1.13 NM',
    'VRM2 0.49 NM',
  ]);
  tools.markNext(set, polar(ship, 900, 4.5), ship);
  assert.deepEqual(tools.readouts(set, ship), []);
});

test('a bearing line is true or relative, and stays where it is when that is changed', () => {
  const ship = own();
  const [line] = tools.newTools().ebl;
  Object.assign(line, { on: true, bearing: radians(20) });
  tools.setRelative(line, true, ship);
  near(degrees(line.bearing), 343);
  near(tools.mapBearing(line, ship), radians(20));
  ship.heading = radians(90); // the relative one turns with the ship
  near(degrees(tools.mapBearing(line, ship)), 73);
  tools.setRelative(line, false, ship);
  near(degrees(line.bearing), 73);
});

test('without a heading a true line is not drawn, a relative one goes by the last bow', () => {
  const lost = own({ heading: null, bow: radians(300) });
  const set = tools.newTools();
  Object.assign(set.ebl[0], { on: true, bearing: 1 });
  Object.assign(set.ebl[1], { on: true, bearing: radians(10), relative: true });
  assert.equal(tools.mapBearing(set.ebl[0], lost), null);
  near(degrees(tools.mapBearing(set.ebl[1], lost)), 310);
  assert.deepEqual(tools.readouts(set, lost), ['EBL1 –° T', 'EBL2 010.0° R']);
  tools.reset(set);
  tools.markNext(set, polar(lost, 500, 333), lost);
  assert.ok(set.ebl[0].relative);
  near(degrees(set.ebl[0].bearing), 33);
});

test('an origin is fixed to the ground or goes along with own ship', () => {
  const ship = own();
  const [fixed, moving] = tools.newTools().vrm;
  const place = [ship.x + 700, ship.y - 250];
  fixed.origin = tools.originAt('ground', place, ship);
  moving.origin = tools.originAt('ship', place, ship);
  const later = { ...ship, x: ship.x + 400, y: ship.y + 90 };
  assert.deepEqual(tools.originOf(fixed, later), place);
  assert.deepEqual(tools.originOf(moving, later), [place[0] + 400, place[1] + 90]);
  assert.deepEqual(tools.originOf({ ...fixed, origin: null }, later), [later.x, later.y]);
  const set = { ...tools.newTools(), vrm: [fixed, moving] };
  fixed.on = moving.on = true;
  assert.match(tools.readouts(set, ship).join(), /VRM1 .* offset, fixed.*VRM2 .* offset, moving/);
});

test('line and marker are taken hold of where they are drawn, and follow the mouse', () => {
  const ship = own();
  const { view } = scope.scopeOf({ own: ship }, settings(), 900, 800, scope.newHeld());
  const screen = (x, y) => toScreen(view, x, y);
  const set = tools.newTools();
  tools.markNext(set, polar(ship, 2600, 120), ship);
  set.vrm[0].on = false;
  const grip = tools.gripAt(set, ship, view, screen, screen(...polar(ship, 1500, 121)));
  assert.ok(grip);
  grip(polar(ship, 3000, 211), ship);
  near(degrees(set.ebl[0].bearing), 211);
  assert.equal(tools.gripAt(set, ship, view, screen, screen(...polar(ship, 1500, 121))), null);
  assert.equal(tools.gripAt(set, ship, view, screen, screen(...polar(ship, 3000, 31))), null);
  Object.assign(set.vrm[1], { on: true, range: 2000 });
  const ring = tools.gripAt(set, ship, view, screen, screen(...polar(ship, 2010, 5)));
  ring(polar(ship, 777, 99), ship);
  near(set.vrm[1].range, 777);
});

// -- parallel index lines, measure -----------------------------------------------------------

test('an index line lies beside own ship, cut where it is told, and goes through the cursor', () => {
  const ship = own();
  const [line] = tools.newTools().lines;
  Object.assign(line, { bearing: radians(90), distance: 400, from: -1000, to: 2500 });
  const [begin, end] = tools.lineEnds(line, ship, 9e4);
  near(begin[0], ship.x - 1000);
  near(begin[1], ship.y - 400); // to starboard of east: south
  near(end[0], ship.x + 2500);
  Object.assign(line, { bearing: radians(330), from: null, to: null });
  const place = polar(ship, 1300, 200);
  tools.lineThrough(line, place, ship);
  const [a, b] = tools.lineEnds(line, ship, 9e4);
  const across = (b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0]);
  near(across / Math.hypot(b[0] - a[0], b[1] - a[1]), 0, 1e-6);
  near(degrees(rangeBearing(...a, ...b)[1]), 330);
  near(Math.hypot(b[0] - a[0], b[1] - a[1]), 1.8e5, 1e-6);
});

test('a relative index line turns with the ship, there are four', () => {
  const ship = own();
  const { lines } = tools.newTools();
  assert.equal(lines.length, 4);
  Object.assign(lines[2], { relative: true, bearing: radians(0), distance: -600 });
  const [a, b] = tools.lineEnds(lines[2], ship, 1000);
  near(degrees(rangeBearing(...a, ...b)[1]), 37);
});

test('index lines come back as they were kept, and rubbish does not', () => {
  const before = tools.newTools();
  Object.assign(before.lines[1], { on: true, bearing: 2, distance: -700, from: -90, to: null });
  const after = tools.newTools();
  tools.restoreLines(after, JSON.parse(JSON.stringify(before.lines)));
  assert.deepEqual(after.lines, before.lines);
  for (const rubbish of [null, 7, [3, null], [{ on: 'yes', bearing: null, from: 'x', more: 1 }]]) {
    const set = tools.newTools();
    tools.restoreLines(set, rubbish);
    assert.deepEqual(set, tools.newTools());
  }
});

test('the measure tells bearing and distance of two places', () => {
  const set = tools.newTools();
  set.measure = [
    [100, 100],
    [100 - 926, 100],
  ];
  assert.deepEqual(tools.readouts(set, own()), ['A to B 270.0° T 0.500 NM']);
});

// -- off-centre, true motion -----------------------------------------------------------------

test('own ship goes where she is put, at most 75 % of the radius off, in every orientation', () => {
  for (const orientation of ['north-up', 'head-up', 'course-up']) {
    const state = { own: own() };
    const held = { ...scope.newHeld(), courseUp: 2 };
    const before = scope.scopeOf(state, settings({ orientation }), 1000, 700, held);
    for (const [x, y, whole] of [
      [640, 260, true],
      [560, 610, false],
      [-4000, 350, false],
    ]) {
      const put = scope.putOwnShip(before, held, [x, y]);
      assert.equal(put.all, whole);
      const after = settings({ orientation, ...put.settings });
      const { view, middleX, middleY, radius } = scope.scopeOf(state, after, 1000, 700, held);
      const away = Math.hypot(view.centreX - middleX, view.centreY - middleY) / radius;
      if (whole) {
        near(view.centreX, x);
        near(view.centreY, y);
      } else near(away, 0.75);
    }
  }
});

test('off-centre ahead gives half a radius more view ahead', () => {
  const state = { own: own() };
  const asked = settings({ orientation: 'head-up', offCentre: 'ahead' });
  const { view, middleX, middleY, radius } = scope.scopeOf(state, asked, 800, 800, scope.newHeld());
  near(view.centreX, middleX);
  near(view.centreY - middleY, radius / 2);
});

test('in true motion own ship moves over a picture that stands still, and is reset at 75 %', () => {
  const state = { own: own() };
  const held = scope.newHeld();
  const asked = settings({ motion: 'true' });
  const buoy = [state.own.x + 500, state.own.y + 3000];
  const off = [];
  let resets = 0;
  let still = null;
  for (let step = 0; step < 3000; step++) {
    const anchor = held.anchor;
    scope.keepInSight(held, state, asked);
    const found = scope.scopeOf(state, asked, 900, 700, held);
    assert.equal(found.motion, 'true');
    const { view, middleX, middleY, radius } = found;
    off.push(Math.hypot(view.centreX - middleX, view.centreY - middleY) / radius);
    const [x, y] = toScreen(view, ...buoy);
    if (held.anchor === anchor && still) {
      near(x, still[0], 1e-6);
      near(y, still[1], 1e-6);
    } else resets++;
    still = [x, y];
    state.own.x += state.own.vx * 2;
    state.own.y += state.own.vy * 2;
  }
  assert.ok(resets >= 3);
  assert.ok(Math.max(...off) <= 0.75 + 1e-9 && Math.max(...off) > 0.74);
  near(off[0], 0.5);
  // Behind the middle, on her course: the longest view ahead.
  held.anchor = null;
  scope.keepInSight(held, state, asked);
  const { view, middleX, middleY } = scope.scopeOf(state, asked, 900, 700, held);
  const course = Math.atan2(state.own.vx, state.own.vy);
  const [right, down] = direction(view, course);
  near((middleX - view.centreX) / right, (middleY - view.centreY) / down, 1e-6);
  assert.ok((middleX - view.centreX) * right > 0);
});

test('head-up, or without a heading, there is no true motion', () => {
  for (const [ship, orientation] of [
    [own(), 'head-up'],
    [own({ heading: null, bow: 1 }), 'north-up'],
  ]) {
    const held = { ...scope.newHeld(), anchor: [0, 0] };
    const asked = settings({ motion: 'true', orientation });
    scope.keepInSight(held, { own: ship }, asked);
    assert.equal(held.anchor, null);
    assert.equal(scope.scopeOf({ own: ship }, asked, 500, 500, held).motion, 'relative');
  }
});

test('own ship that is dragged in true motion moves the picture, not herself', () => {
  const state = { own: own() };
  const held = { ...scope.newHeld(), anchor: [state.own.x, state.own.y + 800] };
  const asked = settings({ motion: 'true', orientation: 'course-up' });
  held.courseUp = 1.1;
  const before = scope.scopeOf(state, asked, 800, 600, held);
  const put = scope.putOwnShip(before, held, [333, 222]);
  held.anchor = put.anchor;
  const { view } = scope.scopeOf(state, asked, 800, 600, held);
  near(view.centreX, 333);
  near(view.centreY, 222);
});

// -- places on Earth -------------------------------------------------------------------------

test('latitude and longitude of a range and bearing are those of the geodesic', () => {
  // From GeographicLib, by pyproj: latitude, longitude, bearing, range, and the place there.
  for (const [latitude, longitude, bearing, range, north, east] of [
    [54.1, -10.9, 37.2, 22000, 54.257260966, -10.695902694],
    [-33.9, 151.3, 181.5, 150000, -35.251698499, 151.256858841],
    [0.4, 179.95, 88, 9000, 0.402840181, -179.969198891],
    [71.2, -179.99, 271.5, 4000, 71.200905535, 179.898867872],
    [0, 10, 0, 5000, 0.045218474, 10.0],
    [89.2, 40, 123, 60000, 88.818193457, 62.410136465],
    [12.5, -45, 359.6, 177792, 14.107001368, -45.011492931],
  ]) {
    const found = placeAt(latitude, longitude, range, radians(bearing));
    near(found[0], north, 2e-9);
    near(found[1], east, 2e-9);
  }
  assert.equal(placeAt(null, 3, 10, 0), null);
  assert.equal(placeAt(3, 3, NaN, 0), null);
});

test('the cursor has range, bearing and place; without fix or heading it says no position', () => {
  const ship = own({ latitude: 54.1, longitude: -10.9 });
  const place = polar(ship, 22000, 37.2);
  const [first, second] = cursorLines(place, ship);
  assert.equal(first, `cursor 037.2° T ${(22000 / NAUTICAL_MILE).toFixed(2)} NM`);
  assert.equal(second, '54°15.436′N 010°41.754′W');
  assert.equal(cursorLines(place, { ...ship, latitude: null })[1], 'no position');
  const lost = { ...ship, heading: null, bow: radians(7.2) };
  assert.deepEqual(cursorLines(place, lost), [
    `cursor 030.0° R ${(22000 / NAUTICAL_MILE).toFixed(2)} NM`,
    'no position',
  ]);
});

test('of several radars the picture says which they are, and which is silent', () => {
  const scan = (radar, name, at) => ({ radar, name, at, x: [], y: [] });
  const state = {
    offset: 1000,
    plots: [scan(1, 's', 1052), scan(0, 'x', 1049), scan(0, 'x', 1053)],
  };
  assert.deepEqual(radars(state, 54), ['x', 's']);
  state.plots[0] = scan(1, 's', 1031.5);
  assert.deepEqual(radars(state, 54), ['x', 's: silent for 22 s']);
  assert.deepEqual(radars({ ...state, plots: [scan(0, '', 1052)] }, 54), []);
});
