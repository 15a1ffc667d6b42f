// Predicted areas of danger, and the ring of safe courses around own ship. The server sends them only
// while this page asks for them.

import { canvasAngle, edge, radians, toScreen } from './geometry.js';
import { Layer } from './layers.js';
import { serverNow } from './state.js';

const OLD_S = 5; // beyond a scan: areas of another time are not drawn
const INSIDE = 5; // px from the edge of the picture to the ring
const FAINT = 0.12; // fill of an area where the danger is just above its limit
const FULL = 0.5; // and where it is sure
const TURN = 2 * Math.PI;
const layer = new Layer();

/** @typedef {import('./state.js').State} State */

/** Whether this viewer looks at areas or at the ring. */
const wanted = (settings) => settings.areas === 'on' || settings.safeCourses === 'on';

let asked = null; // the connection that was told, and what
let told = false;

/** To be called often: tells the server what this page wants, also after a new connection. */
export function keepWatch(settings, /** @type {import('./link.js').Link} */ link) {
  const { socket } = link;
  if (socket?.readyState !== WebSocket.OPEN) return;
  if (asked === socket ? told === wanted(settings) : !wanted(settings)) return;
  asked = socket;
  told = wanted(settings);
  link.send('watch', { areas: told ? 1 : 0 });
}

/** The newest areas; null where they are old, or not asked for. @param {State} state */
function fresh(state, settings, local) {
  if (!wanted(settings) || !state.areas || !state.own) return null;
  const age = serverNow(state, local) - state.areas.at;
  return age < (state.scan?.period ?? 0) + OLD_S ? state.areas : null;
}

/** Words for the corner of the picture. @param {State} state @param {number} local s */
export function dangersSay(state, settings, local) {
  if (!wanted(settings)) return '';
  const areas = fresh(state, settings, local);
  const what = settings.areas === 'on' ? 'danger areas' : 'safe courses';
  if (!areas) return `\n${what}: waiting`;
  if (areas.safe === null) return `\n${what}: own ship's way is not known`;
  const limits = state.limits;
  const within = limits ? ` CPA ${limits.cpa_limit_nm} NM in ${limits.tcpa_limit_min} min` : '';
  return `\n${what}:${within}`;
}

/**
 * The areas, under the targets.
 * @param {CanvasRenderingContext2D} canvas @param {State} state
 */
export function drawAreas(canvas, state, settings, scope, colors, local) {
  const areas = settings.areas === 'on' ? fresh(state, settings, local) : null;
  if (!areas?.areas.length) return;
  const { view } = scope;
  const lies = [...Object.values(view), settings.palette, settings.labels];
  layer.onto(canvas, [...lies, areas.at], (pen) => {
    const [x, y] = toScreen(view, areas.x, areas.y);
    for (const area of areas.areas) drawArea(pen, view, x, y, area, settings, colors);
  });
}

/** One area: own ship's place at x, y px; the fill is the stronger the likelier the danger. */
function drawArea(pen, view, x, y, area, settings, colors) {
  const angles = area.course.map((course) => canvasAngle(view, radians(course)));
  const at = (angle, way) => [
    x + way * view.scale * Math.cos(angle),
    y + way * view.scale * Math.sin(angle),
  ];
  const outline = new Path2D();
  angles.forEach((angle, k) => outline.lineTo(...at(angle, area.far[k])));
  for (let k = angles.length - 1; k >= 0; k--) outline.lineTo(...at(angles[k], area.near[k]));
  outline.closePath();
  const field = pen.createConicGradient(angles[0], x, y);
  angles.forEach((angle, k) => {
    const place = Math.min((angle - angles[0]) / TURN, 1);
    const strength = FAINT + (FULL - FAINT) * area.probability[k];
    field.addColorStop(place, faded(colors.area, strength));
  });
  pen.fillStyle = field;
  pen.fill(outline);
  pen.strokeStyle = colors.area;
  pen.lineWidth = 1.5;
  pen.setLineDash([6, 3]);
  pen.stroke(outline);
  pen.setLineDash([]);
  if (!area.number || settings.labels === 'off') return;
  const middle = Math.floor(angles.length / 2);
  const [textX, textY] = at(angles[middle], (area.near[middle] + area.far[middle]) / 2);
  pen.fillStyle = colors.area;
  pen.font = '600 12px system-ui, sans-serif';
  pen.textAlign = 'center';
  pen.textBaseline = 'middle';
  pen.fillText(String(area.number).padStart(2, '0'), textX, textY);
}

/** #rrggbb with an opacity of 0 to 1. */
function faded(/** @type {string} */ color, /** @type {number} */ opacity) {
  return (
    color +
    Math.round(255 * opacity)
      .toString(16)
      .padStart(2, '0')
  );
}

/** The ring of courses without a trial. @param {State} state */
export function drawSafeCourses(canvas, state, settings, scope, colors, local) {
  const areas = settings.safeCourses === 'on' ? fresh(state, settings, local) : null;
  if (areas?.safe && !state.trial.on) drawRing(canvas, scope, colors, areas.safe);
}

/**
 * Courses as seen from own ship, inside the bearing scale: safe ones a thick line, the others broken
 * and with another colour.
 * @param {number[][]} safe  first and last course of each safe sector, degrees
 */
export function drawRing(canvas, { view, middleX, middleY, radius }, colors, safe) {
  const sectors = safe
    .map(([first, last]) => [first, last < first ? last + 360 : last])
    .sort(([a], [b]) => a - b);
  const along = (first, last) => {
    canvas.beginPath();
    const steps = Math.max(Math.ceil(last - first), 1);
    for (let k = 0; k <= steps; k++) {
      const bearing = radians(first + (k * (last - first)) / steps);
      canvas.lineTo(...edge(view, bearing, middleX, middleY, radius - INSIDE));
    }
    canvas.stroke();
  };
  canvas.strokeStyle = colors.safe;
  canvas.lineWidth = 6;
  for (const [first, last] of sectors) along(first, last);
  canvas.strokeStyle = colors.danger;
  canvas.lineWidth = 4;
  canvas.setLineDash([5, 6]);
  sectors.forEach(([, last], k) => {
    const next = sectors[(k + 1) % sectors.length][0];
    const until = k + 1 < sectors.length ? next : next + 360;
    if (until - last > 0.01 && until - last < 360) along(last, until);
  });
  if (!sectors.length) along(0, 360);
  canvas.setLineDash([]);
}
