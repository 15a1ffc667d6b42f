// Numbers as seamen write them. What is not known is an empty dash, never 0.

import { KNOT, NAUTICAL_MILE, degrees, wrap } from './geometry.js';

export const NONE = '–';

/** @param {number|null|undefined} value @param {number} digits @returns {string} */
export function number(value, digits) {
  return value === null || value === undefined || !Number.isFinite(value)
    ? NONE
    : value.toFixed(digits);
}

/** A bearing as 007.5, in degrees. @param {number|null|undefined} angle rad @returns {string} */
export function bearing(angle) {
  if (angle === null || angle === undefined || !Number.isFinite(angle)) return NONE;
  const tenths = Math.round(degrees(wrap(angle)) * 10) % 3600;
  return (tenths / 10).toFixed(1).padStart(5, '0');
}

/** @param {number|null|undefined} metres @param {number} [digits] @returns {string} NM */
export function miles(metres, digits = 2) {
  return number(metres === null || metres === undefined ? null : metres / NAUTICAL_MILE, digits);
}

/** @param {number|null|undefined} speed m/s @returns {string} kn */
export function knots(speed) {
  return number(speed === null || speed === undefined ? null : speed / KNOT, 1);
}

/** @param {number|null|undefined} seconds @returns {string} min */
export function minutes(seconds) {
  return number(seconds === null || seconds === undefined ? null : seconds / 60, 1);
}

/** 15 s, 6 min. @param {number} time  min */
export function duration(time) {
  return time < 1 ? `${Math.round(60 * time)} s` : `${time} min`;
}

/** 54°05.123′N. @param {number|null} latitude deg @param {number|null} longitude deg */
export function place(latitude, longitude) {
  if (latitude === null || longitude === null) return NONE;
  return `${part(latitude, 2, 'NS')} ${part(longitude, 3, 'EW')}`;
}

function part(
  /** @type {number} */ value,
  /** @type {number} */ width,
  /** @type {string} */ ends,
) {
  const thousandths = Math.round(Math.abs(value) * 60000);
  const whole = String(Math.floor(thousandths / 60000)).padStart(width, '0');
  const rest = ((thousandths % 60000) / 1000).toFixed(3).padStart(6, '0');
  return `${whole}°${rest}′${value < 0 ? ends[1] : ends[0]}`;
}

/** 12:34:56 of seconds since 1970, UTC. @param {number} seconds */
export function clock(seconds) {
  return new Date(seconds * 1000).toISOString().slice(11, 19);
}
