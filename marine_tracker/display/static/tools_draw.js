// Bearing lines, range markers, index lines and the measure, drawn as SN.1/Circ.243 has them: EBL
// dashed, VRM a dashed circle, the second of each with other dashes.

import { direction, toScreen } from './geometry.js';
import { farthestSeen } from './scope.js';
import { lineEnds, mapBearing, originOf } from './tools.js';

const DASHES = [
  [9, 5],
  [3, 5],
];

/**
 * @param {import('./state.js').State} state @param {import('./scope.js').Scope} scope
 * @param {import('./surround.js').Marks} marks
 */
export function drawTools(canvas, state, scope, colors, { tools, asked }) {
  const { view } = scope;
  const own = state.own;
  canvas.strokeStyle = canvas.fillStyle = colors.marker;
  canvas.font = '600 12px system-ui, sans-serif';
  canvas.textBaseline = 'middle';
  canvas.textAlign = 'left';
  canvas.lineWidth = 1.2;
  if (own) {
    tools.lines.forEach((line, k) => line.on && drawLine(canvas, line, k, own, scope));
    tools.ebl.forEach((line, k) => line.on && drawEbl(canvas, line, k, own, scope));
    tools.vrm.forEach((marker, k) => {
      if (!marker.on) return;
      const [x, y] = toScreen(view, ...originOf(marker, own));
      canvas.setLineDash(DASHES[k]);
      canvas.beginPath();
      canvas.arc(x, y, marker.range * view.scale, 0, 2 * Math.PI);
      canvas.stroke();
    });
    canvas.setLineDash([]);
  }
  drawMeasure(canvas, tools.measure, view);
  if (asked) drawAsked(canvas, toScreen(view, asked[0], asked[1]));
}

function drawEbl(canvas, line, k, own, scope) {
  const bearing = mapBearing(line, own);
  if (bearing === null) return;
  const [x, y] = toScreen(scope.view, ...originOf(line, own));
  const [right, down] = direction(scope.view, bearing);
  const long = 4 * scope.radius + Math.hypot(x - scope.middleX, y - scope.middleY); // to the edge
  canvas.setLineDash(DASHES[k]);
  canvas.beginPath();
  canvas.moveTo(x, y);
  canvas.lineTo(x + long * right, y + long * down);
  canvas.stroke();
  canvas.setLineDash([]);
  if (line.origin) {
    canvas.beginPath();
    canvas.arc(x, y, 3, 0, 2 * Math.PI);
    canvas.fill();
  }
}

function drawLine(canvas, line, k, own, scope) {
  const { view } = scope;
  const ends = lineEnds(line, own, 2 * farthestSeen(scope) + Math.abs(line.distance));
  if (!ends) return;
  canvas.beginPath();
  canvas.moveTo(...toScreen(view, ends[0][0], ends[0][1]));
  canvas.lineTo(...toScreen(view, ends[1][0], ends[1][1]));
  canvas.stroke();
  // Its number beside the point that is nearest to own ship.
  const bearing = mapBearing(line, own);
  const [right, down] = direction(view, bearing + Math.PI / 2);
  const away = line.distance * view.scale + (line.distance < 0 ? -10 : 10);
  canvas.fillText(`P${k + 1}`, view.centreX + away * right - 6, view.centreY + away * down);
}

function drawMeasure(canvas, measure, view) {
  const places = measure.map((place) => toScreen(view, place[0], place[1]));
  places.forEach(([x, y], k) => {
    canvas.beginPath();
    canvas.arc(x, y, 4, 0, 2 * Math.PI);
    canvas.stroke();
    canvas.fillText('AB'[k], x + 7, y - 7);
  });
  if (places.length < 2) return;
  canvas.beginPath();
  canvas.moveTo(...places[0]);
  canvas.lineTo(...places[1]);
  canvas.stroke();
}

/** Where somebody asked why there is no target: a question mark. */
function drawAsked(canvas, [x, y]) {
  canvas.beginPath();
  canvas.arc(x, y, 9, 0, 2 * Math.PI);
  canvas.stroke();
  canvas.textAlign = 'center';
  canvas.font = '700 13px system-ui, sans-serif';
  canvas.fillText('?', x, y + 1);
}
