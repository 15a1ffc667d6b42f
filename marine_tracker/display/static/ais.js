// Ships of AIS: triangles by SN.1/Circ.243, of those that radar does not see, or sees elsewhere.

import { toScreen, turned } from './geometry.js';
import { AID, MISMATCH, SART, SLEEPING, alarmOf, shipName, shipsShown } from './ships.js';
import * as symbols from './symbols.js';
import { vectorOf } from './vectors.js';

const FLASH_S = 0.5;
const TURNING = 0.003; // rad/s; a slower turn has no flag
const OUTLINE_PX = 28; // 7.5 mm: a longer or wider ship has her outline

/** @typedef {import('./ships.js').Ship} Ship */

/** Which way her triangle points: heading, else course, else up. @param {Ship} ship */
export function direction(ship, up = 0) {
  return ship.heading ?? ship.course ?? up;
}

/**
 * @param {CanvasRenderingContext2D} canvas
 * @param {import('./state.js').State} state @param {import('./settings.js').Settings} settings
 * @param {import('./scope.js').Scope} scope @param {Record<string, string>} colors
 * @param {number|null} chosen  id of the selected one @param {number} local s
 * @returns {import('./labels.js').Label[]} what is to be written beside them
 */
export function drawShips(canvas, state, settings, scope, colors, chosen, local) {
  const { view } = scope;
  const off = Math.floor(local / FLASH_S) % 2 === 1;
  /** @type {import('./labels.js').Label[]} */
  const labels = [];
  for (const ship of shipsShown(state, settings)) {
    const [x, y] = toScreen(view, ship.x, ship.y);
    if (ship.id === chosen) symbols.selected(canvas, x, y, colors.selected);
    const told = alarmOf(state.alarms, ship.lost ? 'AIS lost' : 'AIS danger', ship.mmsi);
    if (off && told.endsWith('unacknowledged')) continue;
    const color = ship.alarm || ship.lost ? colors.danger : colors.target;
    if (ship.kind === SART) symbols.beacon(canvas, x, y, colors.danger);
    else if (ship.kind === AID) symbols.aid(canvas, x, y, color);
    else drawShip(canvas, ship, settings, state.own, view, x, y, color);
    const mismatch = ship.state === MISMATCH;
    const needed = mismatch || Boolean(ship.alarm) || ship.id === chosen;
    if (needed || (ship.shown !== SLEEPING && settings.labels === 'on')) {
      const name = shipName(ship);
      labels.push({ x, y, text: mismatch ? `${name} ?` : name, needed });
    }
  }
  return labels;
}

function drawShip(canvas, ship, settings, own, view, x, y, color) {
  const angle = direction(ship, view.up) - view.up;
  const bold = Boolean(ship.alarm);
  const sleeping = ship.shown === SLEEPING && !bold;
  const unknown = !sleeping && ship.cpa === null;
  symbols.triangle(canvas, x, y, angle, color, { sleeping, bold, broken: unknown });
  if (ship.lost) symbols.across(canvas, x, y, color);
  if (sleeping || ship.lost) return;
  drawOutline(canvas, ship, view, x, y, color);
  if (ship.wx !== null) {
    const [right, down] = turned(view, ...vectorOf(settings, own, ship.wx, ship.wy));
    symbols.vector(canvas, x, y, right, down, color, bold);
  }
  if (ship.heading !== null) symbols.headingLine(canvas, x, y, angle, color, flagOf(ship));
}

/** Her outline to scale about her middle, where it is larger than a symbol. @param {Ship} ship */
export function drawOutline(canvas, ship, view, x, y, color) {
  const { length, beam, heading } = ship;
  if (!length || !beam || heading === null) return;
  if (Math.max(length, beam) * view.scale < OUTLINE_PX) return;
  symbols.hull(canvas, x, y, { length, beam, bow: length / 2, heading }, view, color);
}

/** 1 to starboard, -1 to port, 0 where she does not turn or does not tell. @param {Ship} ship */
export function flagOf(ship) {
  return Math.abs(ship.turn ?? 0) < TURNING ? 0 : Math.sign(ship.turn);
}
