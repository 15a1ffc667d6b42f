// Zones on the picture: guard zones with a solid line, exclusion zones with a line and dots; handles
// on the one that is being changed. Their names find room among the labels of targets.

import { toScreen } from './geometry.js';
import { handles, outline } from './zones.js';

const HALF_PX = 5; // of a handle

/**
 * The names of the zones are returned as labels, to be placed with the others.
 * @returns {import('./labels.js').Label[]}
 * @param {import('./state.js').State} state @param {import('./scope.js').Scope} scope
 * @param {import('./surround.js').Marks} marks
 */
export function drawZones(canvas, state, { view }, colors, { draft }) {
  const names = [];
  for (const zone of state.zones.zones) {
    if (draft?.was === zone.name) continue;
    names.push(...drawZone(canvas, zone, state.own, view, colors.marker, 1.2));
  }
  if (!draft) return names;
  names.push(...drawZone(canvas, draft.zone, state.own, view, colors.selected, 2));
  handles(draft.zone, state.own).forEach((handle, k) => {
    const [x, y] = toScreen(view, handle.x, handle.y);
    const box = [x - HALF_PX, y - HALF_PX, 2 * HALF_PX, 2 * HALF_PX];
    if (k === draft.handle) canvas.fillRect(...box);
    else canvas.strokeRect(...box);
  });
  return names;
}

function drawZone(canvas, zone, own, view, color, width) {
  const lines = outline(zone, own).map((line) => line.map(([x, y]) => toScreen(view, x, y)));
  if (!lines.length) return [];
  canvas.strokeStyle = canvas.fillStyle = color;
  canvas.lineWidth = width;
  canvas.setLineDash(zone.kind === 'exclusion' ? [10, 3, 2, 3] : []);
  for (const line of lines) {
    canvas.beginPath();
    line.forEach(([x, y]) => canvas.lineTo(x, y));
    canvas.closePath();
    canvas.stroke();
  }
  canvas.setLineDash([]);
  // Its name at its highest point.
  const [x, y] = lines.flat().reduce((best, place) => (place[1] < best[1] ? place : best));
  return [{ x, y, text: zone.name, needed: false }];
}
