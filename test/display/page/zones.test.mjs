// Zones on the page: where they lie, how they are dragged, and what goes to the tracker.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const page = new URL('../../../marine_tracker/display/static/', import.meta.url);
const { radians, degrees, rangeBearing } = await import(new URL('geometry.js', page));
const zones = await import(new URL('zones.js', page));

const near = (a, b, within = 1e-6) => assert.ok(Math.abs(a - b) <= within, `${a} is not ${b}`);
const own = { x: 5100, y: -860, heading: radians(217), vx: 1, vy: 1 };
const base = { name: 'z', kind: 'guard', fixed_to: 'ship', range: null, bearing: null };
const sector = { ...base, range: [900, 1700], bearing: [radians(350), radians(55)], corners: null };
const ring = { ...base, range: [300, 450], corners: null };
const ground = { ...base, fixed_to: 'ground' };
ground.corners = [
  [5000, 0],
  [6000, 200],
  [5600, 900],
];
const onShip = { ...base, corners: ground.corners.map(([x, y]) => [x / 9, y / 9]) };
const place = (range, relative) => [
  own.x + range * Math.sin(own.heading + radians(relative)),
  own.y + range * Math.cos(own.heading + radians(relative)),
];

test('a sector lies where the tracker takes it to be: from the bow, clockwise', () => {
  assert.ok(zones.contains(sector, place(1300, 0), own));
  assert.ok(zones.contains(sector, place(1300, 44), own));
  assert.ok(!zones.contains(sector, place(1300, 46.5), own));
  assert.ok(!zones.contains(sector, place(1300, 348), own));
  assert.ok(!zones.contains(sector, place(880, 10), own));
  assert.ok(
    zones.contains(ring, place(400, 123), own) && !zones.contains(ring, place(200, 5), own),
  );
});

test('corners are to starboard and ahead of own ship, or east and north', () => {
  const [[first]] = zones.outline(onShip, own);
  const [range, bearing] = rangeBearing(own.x, own.y, ...first);
  near(range, 5000 / 9);
  near(degrees(bearing), (217 + 90) % 360); // [x, 0] is abeam to starboard
  assert.deepEqual(zones.outline(ground, own)[0], ground.corners);
});

for (const [name, zone] of Object.entries({ sector, ring, ground, onShip })) {
  test(`each handle of a zone comes to where it is dragged: ${name}`, () => {
    zones.handles(zone, own).forEach(({ what, x, y }) => {
      const [range, bearing] = rangeBearing(own.x, own.y, x, y);
      // A little further out and round: no handle meets its opposite.
      const to = [
        own.x + (range + 40) * Math.sin(bearing + 0.05),
        own.y + (range + 40) * Math.cos(bearing + 0.05),
      ];
      const changed = zones.withHandle(zone, what, to, own);
      const after = zones.handles(changed, own).find((handle) => handle.what === what);
      const [rangeAfter, bearingAfter] = rangeBearing(own.x, own.y, after.x, after.y);
      if (zone.corners || what === 'near' || what === 'far') near(rangeAfter, range + 40);
      if (zone.corners || what === 'first' || what === 'last') near(bearingAfter, bearing + 0.05);
      const others = zones.handles(zone, own).length - 1;
      assert.equal(zones.handles(changed, own).length - 1, others);
    });
  });

  test(`the whole zone goes along: ${name}`, () => {
    const from = zones.outline(zone, own)[0][0];
    const [range, bearing] = rangeBearing(own.x, own.y, ...from);
    const to = [
      own.x + (range + 120) * Math.sin(bearing - 0.3),
      own.y + (range + 120) * Math.cos(bearing - 0.3),
    ];
    const there = zones.outline(zones.moved(zone, from, to, own), own)[0][0];
    if (name === 'ring') near(rangeBearing(own.x, own.y, ...there)[0], range + 120);
    else {
      near(there[0], to[0], 1e-6);
      near(there[1], to[1], 1e-6);
    }
  });
}

test('a near side is never dragged beyond the far one, nor a range below 0', () => {
  const [x, y] = place(4000, 10);
  assert.ok(zones.withHandle(sector, 'near', [x, y], own).range[0] < 1700);
  const inward = zones.moved(sector, place(1500, 0), place(10, 0), own);
  assert.ok(inward.range[0] >= 0 && inward.range[1] - inward.range[0] === 800);
});

test('corners come and go, three stay', () => {
  const more = zones.withCorner(ground, [5850, 500], own);
  assert.deepEqual(more.corners[2], [5850, 500]); // in the side that is nearest
  assert.equal(zones.withoutCorner(more, 2).corners.length, 3);
  assert.equal(zones.withoutCorner(ground, 0).corners.length, 3);
});

test('a zone that is fixed to the other stays where it is at this moment', () => {
  const before = zones.outline(onShip, own)[0];
  const fixed = zones.fixedTo(onShip, 'ground', own);
  zones.outline(fixed, own)[0].forEach(([x, y], k) => {
    near(x, before[k][0]);
    near(y, before[k][1]);
  });
  const back = zones.fixedTo(fixed, 'ship', own);
  back.corners.forEach(([x, y], k) => {
    near(x, onShip.corners[k][0]);
    near(y, onShip.corners[k][1]);
  });
});

test('the parameter has metres to a tenth and degrees to a tenth', () => {
  assert.deepEqual(zones.toParameter({ ...sector, range: [900.04, 1700.06] }), {
    name: 'z',
    kind: 'guard',
    range_m: [900, 1700.1],
    bearing_deg: [350, 45],
  });
  assert.deepEqual(zones.toParameter(ring), { name: 'z', kind: 'guard', range_m: [300, 450] });
  assert.deepEqual(zones.toParameter(ground).corners_m, ground.corners);
  assert.equal(zones.toParameter(ground).fixed_to, 'ground');
});

test('without a bow only rings and what is fixed to the ground has a place', () => {
  const adrift = { x: 0, y: 0, vx: 0, vy: 0, heading: null, bow: null };
  assert.deepEqual(zones.outline(sector, adrift), []);
  assert.deepEqual(zones.outline(onShip, adrift), []);
  assert.equal(zones.outline(ring, adrift).length, 2);
  assert.equal(zones.outline(ground, adrift).length, 1);
  assert.equal(zones.outline(sector, { ...adrift, bow: 2 }).length, 1);
});

test('new zones of every shape lie ahead, within the range', () => {
  for (const shape of ['sector', 'ring', 'ship', 'ground']) {
    const zone = zones.newZone(shape, 'guard', 'new', 5000, own);
    const [x, y] = place(shape === 'ring' ? 2700 : 2500, 0);
    assert.ok(zones.contains(zone, [x, y], own), shape);
    assert.ok(zones.inWords(zone).startsWith('guard'));
  }
});
