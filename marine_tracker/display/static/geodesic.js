// Latitude and longitude of a place at a range and bearing from another: on WGS 84, along the
// geodesic (T. Vincenty 1975, direct problem).

import { degrees, radians } from './geometry.js';

const LONG = 6378137; // m, half axis
const FLAT = 1 / 298.257223563;
const SHORT = LONG * (1 - FLAT);
const FARTHEST = 2e6; // m; no picture reaches as far
const CLOSE = 1e-13; // rad

/**
 * @param {number} latitude deg @param {number} longitude deg
 * @param {number} range m @param {number} bearing rad from true north
 * @returns {[number, number]|null} deg, longitude in [-180, 180); null where there is no such place
 */
export function placeAt(latitude, longitude, range, bearing) {
  const known = Number.isFinite(latitude) && Number.isFinite(longitude);
  if (!known || Math.abs(latitude) > 90 || !(range <= FARTHEST)) return null;
  const reduced = Math.atan((1 - FLAT) * Math.tan(radians(latitude)));
  const [sinU, cosU] = [Math.sin(reduced), Math.cos(reduced)];
  const [sinA, cosA] = [Math.sin(bearing), Math.cos(bearing)];
  const start = Math.atan2(Math.tan(reduced), cosA);
  const sinAlpha = cosU * sinA;
  const square = (1 - sinAlpha ** 2) * ((LONG / SHORT) ** 2 - 1);
  const root = Math.sqrt(1 + square);
  const k = (root - 1) / (root + 1);
  const [a, b] = [(1 + k * k * 0.25) / (1 - k), k * (1 - 0.375 * k * k)];
  const arc = range / (SHORT * a);
  let sigma = arc;
  for (let turn = 0; turn < 50; turn++) {
    const middle = Math.cos(2 * start + sigma);
    const [sin, cos] = [Math.sin(sigma), Math.cos(sigma)];
    const inner = cos * (2 * middle ** 2 - 1);
    const outer = (b / 6) * middle * (4 * sin ** 2 - 3) * (4 * middle ** 2 - 3);
    const step = b * sin * (middle + (b / 4) * (inner - outer));
    const found = arc + step;
    const done = Math.abs(found - sigma) < CLOSE;
    sigma = found;
    if (done) break;
  }
  const [sin, cos] = [Math.sin(sigma), Math.cos(sigma)];
  const middle = Math.cos(2 * start + sigma);
  const x = sinU * sin - cosU * cos * cosA;
  const north = Math.atan2(sinU * cos + cosU * sin * cosA, (1 - FLAT) * Math.hypot(sinAlpha, x));
  const turned = Math.atan2(sin * sinA, cosU * cos - sinU * sin * cosA);
  const cosSquare = 1 - sinAlpha ** 2;
  const c = (FLAT / 16) * cosSquare * (4 + FLAT * (4 - 3 * cosSquare));
  const more = sigma + c * sin * (middle + c * cos * (2 * middle ** 2 - 1));
  const east = longitude + degrees(turned - (1 - c) * FLAT * sinAlpha * more);
  return [degrees(north), ((((east + 180) % 360) + 360) % 360) - 180];
}
