// The radar picture on its canvas: scale, rings, echoes, targets, own ship.

import { drawShips } from './ais.js';
import { NAUTICAL_MILE, toScreen } from './geometry.js';
import { drawAreas, drawSafeCourses } from './dangers.js';
import { echoKey, paintEchoes } from './echoes.js';
import { Layer, Stamps } from './layers.js';
import { farthestSeen } from './scope.js';
import { RANGES } from './settings.js';
import { drawOwnShip } from './own_ship.js';
import { selection, shipsShown } from './ships.js';
import { drawStationary } from './stationary.js';
import { drawMarks, drawScale, drawSimulation, drawTrial } from './surround.js';
import { LOST, serverNow } from './state.js';
import { paintSpokes, spokesKey } from './spokes.js';
import * as symbols from './symbols.js';
import { drawTargets } from './targets.js';
import { drawTools } from './tools_draw.js';
import { drawZones } from './zones_draw.js';

const around = new Layer(); // sea, rings, bearing scale
const glow = new Layer(); // echoes
const video = new Layer(); // spokes, where they come
const past = new Layer(); // trails
const stamps = new Stamps();

/**
 * @typedef {import('./geometry.js').View} View
 * @typedef {import('./state.js').State} State
 * @typedef {import('./settings.js').Settings} Settings
 * @typedef {import('./scope.js').Scope} Scope
 */

/**
 * Draw everything.
 * @param {CanvasRenderingContext2D} canvas  in CSS pixels
 * @param {State} state @param {Settings} settings @param {Scope} scope
 * @param {Record<string, string>} colors
 * @param {import('./surround.js').Marks} marks
 * @param {number} local s
 */
export function draw(canvas, state, settings, scope, colors, marks, local) {
  const { middleX, middleY, radius } = scope;
  canvas.clearRect(0, 0, canvas.canvas.width, canvas.canvas.height);
  const lies = [...Object.values(scope.view), scope.north, settings.palette];
  const graphics = local >= marks.hidden.graphics;
  around.onto(canvas, [...lies, settings.range, settings.rings, graphics], (pen) => {
    pen.fillStyle = colors.sea;
    pen.beginPath();
    pen.arc(middleX, middleY, radius, 0, 2 * Math.PI);
    pen.fill();
    pen.save();
    pen.clip();
    if (graphics && settings.rings === 'on') drawRings(pen, settings, scope, colors);
    pen.restore();
    drawScale(pen, scope, colors);
  });
  canvas.save();
  canvas.beginPath();
  canvas.arc(middleX, middleY, radius, 0, 2 * Math.PI);
  canvas.clip();
  if (state.spokes) {
    video.onto(canvas, [...lies, ...spokesKey(state, local)], (pen) =>
      paintSpokes(pen, state, scope.view, colors.echo, serverNow(state, local)),
    );
  } else if (state.own) {
    glow.onto(canvas, [...lies, ...echoKey(state, local)], (pen) =>
      paintEchoes(pen, state, scope.view, colors.echo, local),
    );
  }
  if (graphics) {
    const names = drawZones(canvas, state, scope, colors, marks);
    if (state.own) {
      if (settings.trails !== 'off') {
        const shown = [settings.trails, settings.trailMinutes, state.trails?.count];
        past.onto(canvas, [...lies, ...shown, state.scan?.at], (pen) =>
          drawTrails(pen, state, settings, scope, colors),
        );
      }
      drawAreas(canvas, state, settings, scope, colors, local);
      drawStationary(canvas, state.fixed, scope.view, colors.trail);
      drawOwnShip(canvas, state, settings, scope, colors, local >= marks.hidden.heading);
      const { id } = selection(state, marks.id);
      const ships = drawShips(canvas, state, settings, scope, colors, id, local);
      const others = [...names, ...ships];
      drawTargets(canvas, state, settings, scope, colors, id, local, others);
    }
    drawTools(canvas, state, scope, colors, marks);
    drawMarks(canvas, scope, colors, marks);
  }
  canvas.restore();
  if (!graphics) return;
  drawSafeCourses(canvas, state, settings, scope, colors, local);
  if (state.ship?.source === 'simulation') drawSimulation(canvas, scope, colors);
  if (state.trial.on) drawTrial(canvas, state, scope, colors);
}

function drawRings(canvas, settings, scope, colors) {
  const { view } = scope;
  const spacing = RANGES[settings.range][1] * NAUTICAL_MILE;
  const far = farthestSeen(scope);
  canvas.strokeStyle = colors.ring;
  canvas.lineWidth = 1;
  for (let ring = 1; ring * spacing <= far * (1 + 1e-9); ring++) {
    canvas.beginPath();
    canvas.arc(view.centreX, view.centreY, ring * spacing * view.scale, 0, 2 * Math.PI);
    canvas.stroke();
  }
}

function drawTrails(canvas, state, settings, { view }, colors) {
  const trails = state.trails;
  if (!trails) return;
  const relative = settings.trails === 'relative';
  const count = Math.round((60 * settings.trailMinutes) / trails.interval);
  const step = Math.max(1, Math.round(count / 12));
  const last = trails.own.length - 1;
  for (const target of [...state.targets, ...shipsShown(state, settings)]) {
    const trail = trails.targets[target.id];
    if (!trail) continue;
    for (let back = 0; back <= Math.min(count, last); back++) {
      // Dots stay where they are: they hang on whole moments, not on the newest one.
      const moment = last - back;
      if ((trails.count - back) % step || !trail[moment]) continue;
      const [dx, dy] = relative
        ? [state.own.x - trails.own[moment][0], state.own.y - trails.own[moment][1]]
        : [0, 0];
      const [x, y] = toScreen(view, trail[moment][0] + dx, trail[moment][1] + dy);
      stamps.put(canvas, `past ${colors.trail}`, x, y, 3, (pen, middleX, middleY) => {
        pen.fillStyle = colors.trail;
        symbols.pastPosition(pen, middleX, middleY);
      });
    }
  }
}

/**
 * The target or ship under a pixel, or null.
 * @param {State} state @param {Settings} settings @param {View} view
 */
export function targetAt(state, settings, view, x, y, reach = 18) {
  let found = null;
  for (const target of [...state.targets, ...shipsShown(state, settings)]) {
    if (target.x === null || target.status === LOST) continue; // a ship has no status of a track
    const [tx, ty] = toScreen(view, target.x, target.y);
    const away = Math.hypot(tx - x, ty - y);
    if (away <= reach) {
      reach = away;
      found = target;
    }
  }
  return found;
}
