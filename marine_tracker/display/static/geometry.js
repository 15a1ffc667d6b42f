// Map and screen: the one place that turns angles. What is drawn and what is clicked use it alike.
//
// Map: metres, east x and north y. Bearings: radians clockwise from true north.
// Screen: CSS pixels, x to the right and y down.

export const NAUTICAL_MILE = 1852;
export const KNOT = NAUTICAL_MILE / 3600;
const TURN = 2 * Math.PI;

/**
 * How the map lies on the screen.
 * @typedef {object} View
 * @property {number} originX  map position, m, that is drawn at centreX, centreY: own ship's
 * @property {number} originY
 * @property {number} centreX  px
 * @property {number} centreY  px
 * @property {number} scale    px per m
 * @property {number} up       rad, the true bearing that is up on the screen
 */

/** The same angle in [0, 2 pi). @param {number} angle rad @returns {number} */
export function wrap(angle) {
  const wrapped = ((angle % TURN) + TURN) % TURN;
  return wrapped < TURN ? wrapped : 0;
}

/** The difference of two bearings in [-pi, pi). @param {number} angle rad @returns {number} */
export function wrapDifference(angle) {
  return wrap(angle + Math.PI) - Math.PI;
}

/** @param {number} angle rad @returns {number} */
export function degrees(angle) {
  return (angle * 180) / Math.PI;
}

/** @param {number} angle degrees @returns {number} */
export function radians(angle) {
  return (angle * Math.PI) / 180;
}

/**
 * A map position on the screen.
 * @param {View} view @param {number} x m @param {number} y m
 * @returns {[number, number]} px
 */
export function toScreen(view, x, y) {
  const [right, down] = turned(view, x - view.originX, y - view.originY);
  return [view.centreX + right, view.centreY + down];
}

/**
 * A map vector on the screen.
 * @param {View} view @param {number} dx m @param {number} dy m
 * @returns {[number, number]} px to the right and down
 */
export function turned(view, dx, dy) {
  const cos = Math.cos(view.up) * view.scale;
  const sin = Math.sin(view.up) * view.scale;
  return [dx * cos - dy * sin, -(dx * sin + dy * cos)];
}

/**
 * The map position under a pixel: the inverse of toScreen.
 * @param {View} view @param {number} px @param {number} py
 * @returns {[number, number]} m
 */
export function toMap(view, px, py) {
  const right = (px - view.centreX) / view.scale;
  const ahead = (view.centreY - py) / view.scale;
  const cos = Math.cos(view.up);
  const sin = Math.sin(view.up);
  return [view.originX + right * cos + ahead * sin, view.originY - right * sin + ahead * cos];
}

/**
 * The direction on the screen of a true bearing.
 * @param {View} view @param {number} bearing rad
 * @returns {[number, number]} a unit step to the right and down
 */
export function direction(view, bearing) {
  return [Math.sin(bearing - view.up), -Math.cos(bearing - view.up)];
}

/** The angle a canvas wants for a true bearing: clockwise from the right. */
export function canvasAngle(/** @type {View} */ view, /** @type {number} */ bearing) {
  return bearing - view.up - Math.PI / 2;
}

/**
 * Range and true bearing of one map position from another.
 * @returns {[number, number]} m, rad
 */
export function rangeBearing(
  /** @type {number} */ fromX,
  /** @type {number} */ fromY,
  /** @type {number} */ x,
  /** @type {number} */ y,
) {
  return [Math.hypot(x - fromX, y - fromY), wrap(Math.atan2(x - fromX, y - fromY))];
}

/**
 * Where the bearing from a pixel inside a circle reaches the circle's edge; for a picture that is
 * off-centre. The circle has its middle at middleX, middleY.
 * @returns {[number, number]} px
 */
export function edge(
  /** @type {View} */ view,
  /** @type {number} */ bearing,
  /** @type {number} */ middleX,
  /** @type {number} */ middleY,
  /** @type {number} */ radius,
) {
  const [right, down] = direction(view, bearing);
  const offX = view.centreX - middleX;
  const offY = view.centreY - middleY;
  const along = offX * right + offY * down;
  const left = radius * radius - (offX * offX + offY * offY);
  const way = -along + Math.sqrt(Math.max(along * along + left, 0));
  return [view.centreX + way * right, view.centreY + way * down];
}

/**
 * Half axes and tilt of a covariance's ellipse, one standard deviation.
 * @param {number} xx m^2 @param {number} xy @param {number} yy
 * @returns {{long: number, short: number, bearing: number}} m, m, rad of the long axis
 */
export function ellipse(xx, xy, yy) {
  const mean = (xx + yy) / 2;
  const spread = Math.hypot((xx - yy) / 2, xy);
  return {
    long: Math.sqrt(Math.max(mean + spread, 0)),
    short: Math.sqrt(Math.max(mean - spread, 0)),
    bearing: wrap(Math.PI / 2 - 0.5 * Math.atan2(2 * xy, xx - yy)),
  };
}
