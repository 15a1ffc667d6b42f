// Own ship on the picture: heading line, vector, double circle or her outline to scale.

import { edge, turned } from './geometry.js';
import { bowOf } from './scope.js';
import * as symbols from './symbols.js';
import { vectorOf } from './vectors.js';

const OUTLINE_PX = 23; // 6 mm: least length of an outline to scale
const ARROWS = { sea: 1, ground: 2 }; // heads of the vector, by what her way is measured against

/**
 * @param {CanvasRenderingContext2D} canvas
 * @param {import('./state.js').State} state @param {import('./settings.js').Settings} settings
 * @param {import('./scope.js').Scope} scope @param {Record<string, string>} colors
 * @param {boolean} headingLine  whether it is drawn
 */
export function drawOwnShip(canvas, state, settings, scope, colors, headingLine) {
  const { view, middleX, middleY, radius } = scope;
  const { own, ship } = state;
  const known = scope.north || own.bow != null;
  if (headingLine && known) {
    const [x, y] = edge(view, bowOf(own), middleX, middleY, radius);
    canvas.strokeStyle = colors.own;
    canvas.lineWidth = 1.4;
    canvas.beginPath();
    canvas.moveTo(view.centreX, view.centreY);
    canvas.lineTo(x, y);
    canvas.stroke();
  }
  if (settings.vectors === 'true') {
    const way = vectorOf(settings, own, own.wx ?? 0, own.wy ?? 0);
    const [right, down] = turned(view, ...way);
    symbols.vector(canvas, view.centreX, view.centreY, right, down, colors.own, true);
    const heads = ARROWS[own.stabilised] ?? 0;
    symbols.arrowheads(canvas, view.centreX, view.centreY, right, down, colors.own, heads);
  }
  const sized = ship && ship.beam > 0 && ship.length * view.scale >= OUTLINE_PX;
  if (sized && known) {
    const { length, beam, bow } = ship;
    const outline = { length, beam, bow, heading: bowOf(own) };
    symbols.hull(canvas, view.centreX, view.centreY, outline, view, colors.own);
    symbols.cross(canvas, view.centreX, view.centreY, colors.own);
  } else symbols.ownShip(canvas, view.centreX, view.centreY, colors.own);
}
