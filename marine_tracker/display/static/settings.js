// What the viewer chose: kept in this browser, and changed in one place.

/** Range in NM, and the distance between its rings. */
export const RANGES = [
  [0.125, 0.025],
  [0.25, 0.05],
  [0.5, 0.1],
  [0.75, 0.25],
  [1.5, 0.25],
  [3, 0.5],
  [6, 1],
  [12, 2],
  [24, 4],
  [48, 8],
  [96, 16],
];
export const CHOICES = {
  orientation: ['north-up', 'head-up', 'course-up'],
  motion: ['relative', 'true'],
  vectors: ['true', 'relative'],
  vectorMinutes: [1, 3, 6, 12, 30],
  trails: ['true', 'relative', 'off'],
  trailMinutes: [0.25, 0.5, 1, 3, 6, 15, 30],
  labels: ['on', 'off'],
  ships: ['all', 'activated', 'off'],
  rings: ['on', 'off'],
  offCentre: ['off', 'ahead', 'place'],
  areas: ['off', 'on'],
  safeCourses: ['off', 'on'],
  ellipses: ['selected', 'all', 'off'],
  palette: ['day', 'dusk', 'night'],
  sound: ['off', 'on'],
};
const KEY = 'marine_tracker ppi';

/**
 * @typedef {object} Settings
 * @property {number} range  index of RANGES
 * @property {string} orientation
 * @property {string} motion
 * @property {string} vectors
 * @property {number} vectorMinutes
 * @property {string} trails
 * @property {number} trailMinutes
 * @property {string} labels
 * @property {string} ships      of AIS that have symbols
 * @property {string} rings
 * @property {string} offCentre
 * @property {string} areas        predicted areas of danger
 * @property {string} safeCourses  the ring of safe courses
 * @property {string} ellipses     of uncertainty
 * @property {number} offRight  radii from the middle to own ship, where offCentre is `place`
 * @property {number} offDown
 * @property {string} palette
 * @property {string} sound
 */

/** The defaults, with what was chosen before, and what the address asks for (?range=12&...). */
export function load(/** @type {string} */ search) {
  /** @type {Record<string, any>} */
  const settings = {
    range: 6,
    orientation: 'north-up',
    motion: 'relative',
    vectors: 'true',
    vectorMinutes: 6,
    trails: 'true',
    trailMinutes: 6,
    labels: 'on',
    ships: 'all',
    rings: 'on',
    offCentre: 'off',
    areas: 'off',
    safeCourses: 'off',
    ellipses: 'selected',
    offRight: 0,
    offDown: 0,
    palette: 'day',
    sound: 'off',
  };
  const before = kept('') ?? {};
  const asked = Object.fromEntries(new URLSearchParams(search));
  for (const given of [before, asked]) {
    for (const [name, choices] of Object.entries(CHOICES)) {
      const found = choices.find((choice) => String(choice) === String(given[name]));
      if (found !== undefined) settings[name] = found;
    }
  }
  const index = RANGES.findIndex(([range]) => String(range) === asked.range);
  if (Number.isInteger(before.range) && RANGES[before.range]) settings.range = before.range;
  if (index >= 0) settings.range = index;
  if (Math.hypot(before.offRight, before.offDown) <= 0.75) {
    Object.assign(settings, { offRight: before.offRight, offDown: before.offDown });
  }
  return /** @type {Settings} */ (settings);
}

/** What was kept under a name, '' for the settings; null where there is nothing to be read. */
export function kept(/** @type {string} */ name) {
  try {
    return JSON.parse(localStorage.getItem(`${KEY} ${name}`.trim()) ?? 'null');
  } catch {
    return null; // kept by somebody else, or not to be read: the defaults will do
  }
}

export function keep(/** @type {unknown} */ value, name = '') {
  try {
    localStorage.setItem(`${KEY} ${name}`.trim(), JSON.stringify(value));
  } catch {
    // Not allowed here: they hold until the page is closed.
  }
}

/** The choice after the present one; own ship's own place only where she was put somewhere. */
export function next(/** @type {Settings} */ settings, /** @type {string} */ name) {
  const put = name !== 'offCentre' || settings.offRight || settings.offDown;
  const choices = put ? CHOICES[name] : CHOICES[name].filter((choice) => choice !== 'place');
  return choices[(choices.indexOf(settings[name]) + 1) % choices.length];
}
