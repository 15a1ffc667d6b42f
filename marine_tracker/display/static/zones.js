// Guard and exclusion zones: their outlines in the map, and how they are changed by dragging.
//
// Bearings of a sector are from own ship's bow, corners are metres to starboard and ahead of her; of
// a zone that is fixed to the ground they are east and north in the map. As in the tracker.

import { degrees, rangeBearing, wrap } from './geometry.js';
import { bowOf } from './scope.js';

const ARC_STEP = Math.PI / 90;
const LEAST_WIDTH = (2 * Math.PI) / 360;
const LEAST_DEPTH = 20; // m, between the two ranges of a zone

/**
 * @typedef {object} Zone
 * @property {string} name
 * @property {string} kind       guard or exclusion
 * @property {string} fixed_to   ship or ground
 * @property {number[]|null} range   m, nearest and farthest, of a ring or a sector; else null
 * @property {number[]|null} bearing rad from the bow: the first side, and how far round; null: ring
 * @property {number[][]|null} corners  m, of a polygon
 * @typedef {object} Draft
 * @property {Zone} zone         as it will be
 * @property {string} was        the name that the tracker knows; '' of a new one
 * @property {number} handle     that the keyboard moves
 * @typedef {object} Handle
 * @property {string} what       near, far, first, last, or a corner's number
 * @property {number} x          m, in the map
 * @property {number} y
 */

/** Whether a zone can be placed: what goes by the bow needs to know where that is. */
export const placeable = (/** @type {Zone} */ zone, own) =>
  zone.fixed_to === 'ground' ||
  (own && ((zone.range && !zone.bearing) || own.heading !== null || own.bow != null));

function fromBow(own, starboard, ahead) {
  const bow = bowOf(own);
  const [sin, cos] = [Math.sin(bow), Math.cos(bow)];
  return [own.x + starboard * cos + ahead * sin, own.y - starboard * sin + ahead * cos];
}

/** Metres in the axes of a zone, of a map position. */
function inZone(/** @type {Zone} */ zone, own, [x, y]) {
  if (zone.fixed_to === 'ground') return [x, y];
  const bow = bowOf(own);
  const [sin, cos, dx, dy] = [Math.sin(bow), Math.cos(bow), x - own.x, y - own.y];
  return [dx * cos - dy * sin, dx * sin + dy * cos];
}

const placeOf = (zone, own, [x, y]) => (zone.fixed_to === 'ground' ? [x, y] : fromBow(own, x, y));
const polar = (own, range, bearing) =>
  fromBow(own, range * Math.sin(bearing), range * Math.cos(bearing));

/** The outline of a zone: closed lines of map positions, m. @returns {number[][][]} */
export function outline(/** @type {Zone} */ zone, own) {
  if (!placeable(zone, own)) return [];
  if (zone.corners) return [zone.corners.map((corner) => placeOf(zone, own, corner))];
  const [near, far] = zone.range;
  const [first, width] = zone.bearing ?? [0, 2 * Math.PI];
  const steps = Math.ceil(width / ARC_STEP);
  const arc = (range) =>
    Array.from({ length: steps + 1 }, (_, k) => polar(own, range, first + (k / steps) * width));
  if (zone.bearing) return [[...arc(near), ...arc(far).reverse()]];
  return near > 0 ? [arc(far), arc(near)] : [arc(far)];
}

/** Where a zone can be taken hold of. @returns {Handle[]} */
export function handles(/** @type {Zone} */ zone, own) {
  if (!placeable(zone, own)) return [];
  const at = (what, [x, y]) => ({ what, x, y });
  if (zone.corners) {
    return zone.corners.map((corner, k) => at(String(k), placeOf(zone, own, corner)));
  }
  const [near, far] = zone.range;
  const [first, width] = zone.bearing ?? [0, 0];
  const found = [
    at('near', polar(own, near, first + width / 2)),
    at('far', polar(own, far, first + width / 2)),
  ];
  if (!zone.bearing) return found;
  const middle = (near + far) / 2;
  found.push(at('first', polar(own, middle, first)));
  found.push(at('last', polar(own, middle, first + width)));
  return found;
}

/** The zone with a handle at a map position. @returns {Zone} */
export function withHandle(/** @type {Zone} */ zone, /** @type {string} */ what, place, own) {
  if (zone.corners) {
    const corner = inZone(zone, own, place);
    return { ...zone, corners: zone.corners.map((old, k) => (String(k) === what ? corner : old)) };
  }
  const [range, bearing] = rangeBearing(own.x, own.y, place[0], place[1]);
  let [near, far] = zone.range;
  if (what === 'near') near = Math.max(Math.min(range, far - LEAST_DEPTH), 0);
  if (what === 'far') far = Math.max(range, near + LEAST_DEPTH);
  if (!zone.bearing || what === 'near' || what === 'far') return { ...zone, range: [near, far] };
  let [first, width] = zone.bearing;
  const side = wrap(bearing - bowOf(own));
  const last = first + width;
  if (what === 'first') {
    first = side;
    width = Math.max(wrap(last - side), LEAST_WIDTH);
  } else width = Math.max(wrap(side - first), LEAST_WIDTH);
  return { ...zone, bearing: [first, width] };
}

/** The whole zone moved from one map position to another. @returns {Zone} */
export function moved(/** @type {Zone} */ zone, from, to, own) {
  if (zone.corners) {
    const [a, b] = [inZone(zone, own, from), inZone(zone, own, to)];
    const corners = zone.corners.map(([x, y]) => [x + b[0] - a[0], y + b[1] - a[1]]);
    return { ...zone, corners };
  }
  const [before, angleBefore] = rangeBearing(own.x, own.y, from[0], from[1]);
  const [after, angleAfter] = rangeBearing(own.x, own.y, to[0], to[1]);
  const step = Math.max(after - before, -zone.range[0]);
  const range = zone.range.map((one) => one + step);
  if (!zone.bearing) return { ...zone, range };
  const [first, width] = zone.bearing;
  return { ...zone, range, bearing: [wrap(first + angleAfter - angleBefore), width] };
}

/** Whether a map position is inside a zone (even-odd over all its lines). */
export function contains(/** @type {Zone} */ zone, [x, y], own) {
  let inside = false;
  for (const line of outline(zone, own)) {
    line.forEach(([x0, y0], k) => {
      const [x1, y1] = line[(k + 1) % line.length];
      if (y0 > y !== y1 > y && x < x0 + ((y - y0) / (y1 - y0)) * (x1 - x0)) inside = !inside;
    });
  }
  return inside;
}

/** The zone that is fixed to the other: it stays where it is now. @returns {Zone} */
export function fixedTo(/** @type {Zone} */ zone, /** @type {string} */ fixed, own) {
  if (!zone.corners || zone.fixed_to === fixed || !placeable(zone, own)) return zone;
  const places = zone.corners.map((corner) => placeOf(zone, own, corner));
  const other = { ...zone, fixed_to: fixed };
  return { ...other, corners: places.map((place) => inZone(other, own, place)) };
}

/** A new zone to begin with: ahead of own ship, as far out as the picture shows. @returns {Zone} */
export function newZone(/** @type {string} */ shape, /** @type {string} */ kind, name, far, own) {
  const base = { name, kind, fixed_to: 'ship', range: null, bearing: null, corners: null };
  if (shape === 'ring') return { ...base, range: [0.5 * far, 0.6 * far] };
  if (shape === 'sector') {
    return { ...base, range: [0.4 * far, 0.6 * far], bearing: [(11 / 6) * Math.PI, Math.PI / 3] };
  }
  const half = 0.15 * far;
  const ahead = 0.5 * far;
  const corners = [
    [-half, ahead - half],
    [half, ahead - half],
    [half, ahead + half],
    [-half, ahead + half],
  ];
  const polygon = { ...base, corners };
  return shape === 'ground' ? fixedTo(polygon, 'ground', own) : polygon;
}

/** A polygon with one corner more, at a map position: in the side that is nearest. @returns {Zone} */
export function withCorner(/** @type {Zone} */ zone, place, own) {
  if (!zone.corners) return zone;
  const corner = inZone(zone, own, place);
  const away = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  const longer = zone.corners.map((a, k) => {
    const b = zone.corners[(k + 1) % zone.corners.length];
    return away(a, corner) + away(corner, b) - away(a, b);
  });
  const side = longer.indexOf(Math.min(...longer));
  return { ...zone, corners: zone.corners.toSpliced(side + 1, 0, corner) };
}

/** A polygon without one of its corners; three stay. @returns {Zone} */
export function withoutCorner(/** @type {Zone} */ zone, /** @type {number} */ corner) {
  if (!zone.corners || zone.corners.length <= 3) return zone;
  return { ...zone, corners: zone.corners.toSpliced(corner, 1) };
}

/** As the tracker's parameter has it: metres, and degrees to a tenth. */
export function toParameter(/** @type {Zone} */ zone) {
  const { name, kind } = zone;
  const metres = (value) => Math.round(value * 10) / 10;
  if (zone.corners) {
    const corners = zone.corners.map((corner) => corner.map(metres));
    return { name, kind, fixed_to: zone.fixed_to, corners_m: corners };
  }
  const found = { name, kind, range_m: zone.range.map(metres) };
  if (!zone.bearing) return found;
  const tenths = (angle) => (Math.round(degrees(angle) * 10) % 3600) / 10;
  const [first, width] = zone.bearing;
  return { ...found, bearing_deg: [tenths(first), tenths(first + width)] };
}

/** In one line what a zone is. */
export function inWords(/** @type {Zone} */ zone) {
  const miles = (value) => (value / 1852).toFixed(2);
  if (zone.corners) {
    const fixed = zone.fixed_to === 'ground' ? 'fixed to the ground' : 'goes with own ship';
    return `${zone.kind}, ${zone.corners.length} corners, ${fixed}`;
  }
  const ranges = `${zone.range.map(miles).join(' to ')} NM`;
  if (!zone.bearing) return `${zone.kind}, ring ${ranges}`;
  const [first, width] = zone.bearing;
  const side = (angle) => String(Math.round(degrees(wrap(angle))) % 360).padStart(3, '0');
  return `${zone.kind}, ${ranges}, ${side(first)}° to ${side(first + width)}° of the bow`;
}
