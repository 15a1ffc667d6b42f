// The words in the corners of the picture: scale and modes, the cursor's readout, the time.

import { rangeBearing, toMap } from './geometry.js';
import * as format from './format.js';
import { placeAt } from './geodesic.js';
import { STABILISED, element, say } from './panel.js';
import { RANGES } from './settings.js';
import { serverNow } from './state.js';
import { bearingText, readouts } from './tools.js';

const SILENT_RADAR_S = 15; // without plots: longer than three turns of a slow antenna

/**
 * @param {import('./state.js').State} state @param {import('./settings.js').Settings} settings
 * @param {import('./scope.js').Scope} scope @param {import('./surround.js').Marks} marks
 * @param {[number, number]|null} pointer px @param {string} more  lines about dangers
 * @param {number} local s
 */
export function showCorners(state, settings, scope, marks, pointer, more, local) {
  const [range, rings] = RANGES[settings.range];
  element('no-heading').hidden = scope.north;
  say(
    element('scale'),
    `${range} NM\n${settings.rings === 'on' ? `rings ${rings} NM` : 'no rings'}\n` +
      `${scope.orientation}\n${scope.motion} motion`,
  );
  const trails = settings.trails === 'off' ? '' : `, ${format.duration(settings.trailMinutes)}`;
  say(
    element('modes'),
    `vectors ${settings.vectors}, ${settings.vectorMinutes} min\ntrails ${settings.trails}${trails}\n` +
      stabilised(state.own) +
      aisSays(state, settings) +
      more,
  );
  const place = pointer ? toMap(scope.view, ...pointer) : marks.cursor;
  const lines = place && state.own ? cursorLines(place, state.own) : [];
  if (state.own) lines.push(...readouts(marks.tools, state.own));
  say(element('cursor'), lines.join('\n'));
  const time = state.scan ? `${format.clock(state.scan.time)} UTC` : '';
  say(element('time'), [...radars(state, local), time].join('\n'));
}

/** Which radars make the picture, a line each, where there are several; one that is silent says so. */
export function radars(
  /** @type {import('./state.js').State} */ state,
  /** @type {number} */ local,
) {
  const newest = new Map(state.plots.map((scan) => [scan.radar ?? 0, scan]));
  if (newest.size < 2) return [];
  return [...newest.keys()].sort().map((radar) => {
    const { at, name } = newest.get(radar);
    const age = serverNow(state, local) - at;
    return `${name || radar + 1}${age > SILENT_RADAR_S ? `: silent for ${Math.floor(age)} s` : ''}`;
  });
}

/** Range and bearing of a map position from own ship, and where on Earth it is. */
export function cursorLines(/** @type {number[]} */ [x, y], own) {
  const [range, bearing] = rangeBearing(own.x, own.y, x, y);
  // Without north nobody knows in which direction of own ship the place is.
  const known = own.latitude !== null && own.heading !== null;
  const found = known ? placeAt(own.latitude, own.longitude, range, bearing) : null;
  return [
    `cursor ${bearingText(bearing, own)} ${format.miles(range)} NM`,
    found ? format.place(...found) : 'no position',
  ];
}

/** Which ships of AIS show; nothing where none was ever heard. */
function aisSays(/** @type {import('./state.js').State} */ state, settings) {
  return state.ships.length || settings.ships !== 'all' ? `\nAIS ${settings.ships}` : '';
}

/** What courses and speeds are measured against, and by what that is known. */
function stabilised(/** @type {Record<string, any>|null} */ own) {
  if (!own) return STABILISED.none;
  const by = own.stabilised === 'none' ? `: ${own.by}` : `, by ${own.by}`;
  return STABILISED[own.stabilised] + (own.by ? by : '');
}
