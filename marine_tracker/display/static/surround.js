// What is drawn around and over the picture: bearing scale, cursor, markers, a trial's courses.

import { drawRing } from './dangers.js';
import { edge, radians, toScreen, turned } from './geometry.js';

/**
 * What the viewer has marked.
 * @typedef {object} Marks
 * @property {number|null} id           of the selected target's track
 * @property {number[]|null} cursor     map position, m
 * @property {number[]|null} drag       px, to where own ship's vector is being dragged
 * @property {import('./tools.js').Tools} tools
 * @property {import('./zones.js').Draft|null} draft  the zone that is being drawn or changed
 * @property {number[]|null} asked      map position, m, that was asked about
 * @property {{heading: number, graphics: number}} hidden  local s until which they are not drawn
 */

/** The cursor, and the vector that is being dragged. */
export function drawMarks(canvas, { view }, colors, /** @type {Marks} */ marks) {
  if (marks.drag) {
    canvas.strokeStyle = colors.safe;
    canvas.lineWidth = 2;
    canvas.beginPath();
    canvas.moveTo(view.centreX, view.centreY);
    canvas.lineTo(...marks.drag);
    canvas.stroke();
  }
  if (marks.cursor) {
    const [x, y] = toScreen(view, marks.cursor[0], marks.cursor[1]);
    canvas.strokeStyle = colors.cursor;
    canvas.lineWidth = 1.4;
    canvas.beginPath();
    for (const [right, down] of [
      [1, 0],
      [-1, 0],
      [0, 1],
      [0, -1],
    ]) {
      canvas.moveTo(x + 4 * right, y + 4 * down);
      canvas.lineTo(x + 14 * right, y + 14 * down);
    }
    canvas.stroke();
  }
}

/**
 * The bearing scale around the picture: marks each 5 degrees, numbers each 30. From true north, or,
 * where that is not known, from the bow.
 */
export function drawScale(canvas, { view, middleX, middleY, radius, north }, colors) {
  const zero = north ? 0 : view.up;
  canvas.strokeStyle = colors.scale;
  canvas.fillStyle = colors.scale;
  canvas.font = '600 12px system-ui, sans-serif';
  canvas.textAlign = 'center';
  canvas.textBaseline = 'middle';
  canvas.lineWidth = 1;
  canvas.beginPath();
  canvas.arc(middleX, middleY, radius, 0, 2 * Math.PI);
  for (let mark = 0; mark < 360; mark++) {
    if (mark % 5 && radius < 250) continue;
    const [x, y] = edge(view, zero + radians(mark), middleX, middleY, radius);
    const length = mark % 10 === 0 ? 10 : mark % 5 === 0 ? 6 : 3;
    const out = [(x - middleX) / radius, (y - middleY) / radius];
    canvas.moveTo(x, y);
    canvas.lineTo(x + length * out[0], y + length * out[1]);
    if (mark % 30 === 0) {
      canvas.fillText(String(mark).padStart(3, '0'), x + 22 * out[0], y + 20 * out[1]);
    }
  }
  canvas.stroke();
}

/** The S of a picture that is simulated. */
export function drawSimulation(canvas, { middleX, middleY, radius }, colors) {
  canvas.fillStyle = colors.label;
  canvas.font = '700 40px system-ui, sans-serif';
  canvas.textAlign = 'center';
  canvas.textBaseline = 'middle';
  canvas.fillText('S', middleX - 44, middleY + radius - 34);
}

/** Safe and unsafe courses of a trial around the picture, and the T that says that it is one. */
export function drawTrial(canvas, state, scope, colors) {
  const { view, middleX, middleY, radius } = scope;
  if (state.trial.safe_deg) drawRing(canvas, scope, colors, state.trial.safe_deg);
  canvas.fillStyle = colors.danger;
  canvas.font = '700 40px system-ui, sans-serif';
  canvas.textAlign = 'center';
  canvas.textBaseline = 'middle';
  canvas.fillText('T', middleX, middleY + radius - 34);
  const { own, trial } = state;
  if (typeof trial.course_deg !== 'number' || !own) return;
  // On as before until the delay is over, then on the new course.
  const wait = 60 * (trial.countdown_min ?? 0);
  const [x, y] = turned(view, wait * (own.wx ?? 0), wait * (own.wy ?? 0));
  const begin = { ...view, centreX: view.centreX + x, centreY: view.centreY + y };
  canvas.strokeStyle = colors.safe;
  canvas.lineWidth = 2;
  canvas.setLineDash([2, 6]);
  canvas.beginPath();
  canvas.moveTo(view.centreX, view.centreY);
  canvas.lineTo(begin.centreX, begin.centreY);
  canvas.lineTo(...edge(begin, radians(trial.course_deg), middleX, middleY, radius));
  canvas.stroke();
  canvas.setLineDash([]);
}
