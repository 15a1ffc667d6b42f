// What a navigator measures with: bearing lines, range markers, parallel index lines, a measure
// between two points. Only what they are; tools_draw.js draws them.

import { direction, rangeBearing, wrap } from './geometry.js';
import * as format from './format.js';
import { bowOf } from './scope.js';

export const LINES = 4;

/**
 * @typedef {object} Origin  where a bearing line or range marker begins; null: at own ship
 * @property {'ground'|'ship'} with  it stays at its place, or goes along with own ship
 * @property {number} x      m, east: of the map, or from own ship
 * @property {number} y      m, north
 * @typedef {object} Ebl     electronic bearing line
 * @property {boolean} on
 * @property {number} bearing    rad from north; from the bow where relative
 * @property {boolean} relative
 * @property {Origin|null} origin
 * @typedef {object} Vrm     variable range marker
 * @property {boolean} on
 * @property {number} range      m
 * @property {Origin|null} origin
 * @typedef {object} IndexLine   parallel index line: goes along with own ship
 * @property {boolean} on
 * @property {number} bearing    rad from north; from the bow where relative
 * @property {boolean} relative
 * @property {number} distance   m from own ship, to starboard of the bearing; negative to port
 * @property {number|null} from  m along the bearing, where it begins; null: at the edge
 * @property {number|null} to    m, where it ends
 * @typedef {object} Tools
 * @property {Ebl[]} ebl
 * @property {Vrm[]} vrm
 * @property {IndexLine[]} lines
 * @property {number[][]} measure  none, one or two map positions, m
 */

/** @returns {Tools} nothing is on */
export function newTools() {
  const many = (count, make) => Array.from({ length: count }, make);
  return {
    ebl: many(2, () => ({ on: false, bearing: 0, relative: false, origin: null })),
    vrm: many(2, () => ({ on: false, range: 1852, origin: null })),
    lines: many(LINES, () => ({
      on: false,
      bearing: 0,
      relative: false,
      distance: 1852,
      from: null,
      to: null,
    })),
    measure: [],
  };
}

/** Index lines as they were kept; what is not like a line is left as it is. */
export function restoreLines(/** @type {Tools} */ tools, /** @type {any} */ kept) {
  if (!Array.isArray(kept)) return;
  tools.lines.forEach((line, k) => {
    for (const [name, value] of Object.entries(kept[k] ?? {})) {
      const cut = name === 'from' || name === 'to';
      const like = cut
        ? value === null || Number.isFinite(value)
        : typeof value === typeof line[name];
      if (name in line && like) line[name] = value;
    }
  });
}

/** The map position that an EBL or VRM begins at. @returns {[number, number]} m */
export function originOf(/** @type {Ebl|Vrm} */ tool, own) {
  const { origin } = tool;
  if (!origin) return [own.x, own.y];
  return origin.with === 'ground' ? [origin.x, origin.y] : [own.x + origin.x, own.y + origin.y];
}

/** A new origin at a map position: with own ship or fixed to the ground; '' for own ship itself. */
export function originAt(/** @type {string} */ where, /** @type {number[]} */ [x, y], own) {
  if (!where) return null;
  return where === 'ground' ? { with: where, x, y } : { with: where, x: x - own.x, y: y - own.y };
}

/**
 * The bearing in the map, rad, of an EBL or an index line. Null for a true one while the heading is
 * missing: nobody knows then where true north is.
 */
export function mapBearing(/** @type {Ebl|IndexLine} */ tool, own) {
  if (tool.relative) return wrap(bowOf(own) + tool.bearing);
  return own.heading === null ? null : tool.bearing;
}

/** Turn a tool to a bearing of the map, rad. */
export function turnTo(/** @type {Ebl|IndexLine} */ tool, /** @type {number} */ bearing, own) {
  tool.bearing = wrap(tool.relative ? bearing - bowOf(own) : bearing);
}

/** From true to relative bearings, or back; the line stays where it is. */
export function setRelative(
  /** @type {Ebl|IndexLine} */ tool,
  /** @type {boolean} */ relative,
  own,
) {
  const bearing = own && mapBearing(tool, own);
  tool.relative = relative;
  if (bearing !== null && own) turnTo(tool, bearing, own);
}

/** The first EBL and VRM that are off go on and through a map position; after two pairs all go off. */
export function markNext(/** @type {Tools} */ tools, /** @type {number[]} */ [x, y], own) {
  const free = tools.ebl.findIndex((line, k) => !line.on && !tools.vrm[k].on);
  if (free < 0) return reset(tools);
  const [range, bearing] = rangeBearing(own.x, own.y, x, y);
  Object.assign(tools.vrm[free], { on: true, origin: null, range });
  Object.assign(tools.ebl[free], { on: true, origin: null, relative: own.heading === null });
  turnTo(tools.ebl[free], bearing, own);
}

/** All bearing lines and range markers are off, and at own ship again. */
export function reset(/** @type {Tools} */ tools) {
  for (const tool of [...tools.ebl, ...tools.vrm]) Object.assign(tool, { on: false, origin: null });
}

/** An index line goes through a map position; its bearing stays. */
export function lineThrough(/** @type {IndexLine} */ line, /** @type {number[]} */ [x, y], own) {
  const bearing = mapBearing(line, own);
  if (bearing === null) return;
  line.distance = (x - own.x) * Math.cos(bearing) - (y - own.y) * Math.sin(bearing);
}

/**
 * The ends of an index line in the map; null where its bearing is not known.
 * @param {IndexLine} line @param {number} far m, how far a line that is not cut goes
 * @returns {number[][]|null}
 */
export function lineEnds(line, own, far) {
  const bearing = mapBearing(line, own);
  if (bearing === null) return null;
  const [sin, cos] = [Math.sin(bearing), Math.cos(bearing)];
  return [line.from ?? -far, line.to ?? far].map((along) => [
    own.x + along * sin + line.distance * cos,
    own.y + along * cos - line.distance * sin,
  ]);
}

/**
 * What the tools that are on read, a line of words each.
 * @param {Tools} tools
 */
export function readouts(tools, own) {
  const found = [];
  tools.ebl.forEach((line, k) => {
    if (!line.on) return;
    const known = mapBearing(line, own) !== null;
    const bearing = known ? format.bearing(line.bearing) : format.NONE;
    found.push(`EBL${k + 1} ${bearing}° ${line.relative ? 'R' : 'T'}${offset(line)}`);
  });
  tools.vrm.forEach((marker, k) => {
    if (marker.on) found.push(`VRM${k + 1} ${format.miles(marker.range)} NM${offset(marker)}`);
  });
  if (tools.measure.length === 2) {
    const [from, to] = tools.measure;
    const [range, bearing] = rangeBearing(from[0], from[1], to[0], to[1]);
    found.push(`A to B ${bearingText(bearing, own)} ${format.miles(range, 3)} NM`);
  }
  return found;
}

/** A bearing of the map in words: true, or from the bow where north is not known. */
export function bearingText(/** @type {number} */ bearing, own) {
  return own.heading === null
    ? `${format.bearing(bearing - bowOf(own))}° R`
    : `${format.bearing(bearing)}° T`;
}

const offset = (/** @type {Ebl|Vrm} */ tool) =>
  tool.origin ? ` offset, ${tool.origin.with === 'ground' ? 'fixed' : 'moving'}` : '';

/**
 * What of the tools can be dragged at a pixel: a function that takes the map position it is dragged
 * to, or null. Markers and lines at their sign are found within `reach` px.
 * @param {Tools} tools @param {import('./geometry.js').View} view
 * @param {(x: number, y: number) => [number, number]} screen  of a map position
 * @returns {((place: number[], own: any) => void)|null}
 */
export function gripAt(tools, own, view, screen, [px, py], reach = 9) {
  for (const marker of tools.vrm) {
    if (!marker.on) continue;
    const [x, y] = screen(...originOf(marker, own));
    if (Math.abs(Math.hypot(px - x, py - y) - marker.range * view.scale) > reach) continue;
    return (place, ship) => {
      const from = originOf(marker, ship);
      marker.range = rangeBearing(from[0], from[1], place[0], place[1])[0];
    };
  }
  for (const line of tools.ebl) {
    const bearing = line.on ? mapBearing(line, own) : null;
    if (bearing === null) continue;
    const [x, y] = screen(...originOf(line, own));
    const [right, down] = direction(view, bearing);
    const along = (px - x) * right + (py - y) * down;
    const off = (px - x) * down - (py - y) * right;
    // Near its origin a line is not taken hold of: there own ship is.
    if (along < 4 * reach || Math.abs(off) > reach) continue;
    return (place, ship) => {
      const from = originOf(line, ship);
      turnTo(line, rangeBearing(from[0], from[1], place[0], place[1])[1], ship);
    };
  }
  return null;
}
