// Where labels stand: beside their targets, none over another. Those that are needed look for room
// farther out, with a line to their target.

/**
 * @typedef {object} Label
 * @property {number} x          px, of the target
 * @property {number} y
 * @property {string} text
 * @property {boolean} needed    shown even where there is no room (dangerous, selected)
 * @typedef {object} Placed
 * @property {Label} label
 * @property {number} left       px, of the text
 * @property {number} middle     px
 * @property {boolean} far       so far off that a line leads to its target
 */

const HEIGHT = 14;
const AWAY = 11;
const FARTHEST = 9; // times AWAY, for a label that is needed

/**
 * The labels that find room, with the places of their left middles; those needed come first.
 * @param {Label[]} labels @param {(text: string) => number} widthOf px
 * @returns {Placed[]}
 */
export function placed(labels, widthOf) {
  /** @type {Placed[]} */
  const found = [];
  /** @type {Map<number, number[][]>} boxes by the row of HEIGHT in which their middle is */
  const taken = new Map();
  const rowOf = (/** @type {number} */ middle) => Math.floor(middle / HEIGHT);
  const free = (/** @type {number} */ left, /** @type {number} */ middle, width) =>
    [-1, 0, 1].every((near) =>
      (taken.get(rowOf(middle) + near) ?? []).every((box) => apart(box, left, middle, width)),
    );
  const inOrder = [...labels].sort((a, b) => Number(b.needed) - Number(a.needed));
  for (const label of inOrder) {
    const width = widthOf(label.text);
    let place = null;
    let times = 0;
    while (!place && times < (label.needed ? FARTHEST : 1)) {
      times++;
      place = placesAt(label, times * AWAY, width).find(([x, y]) => free(x, y, width));
    }
    if (!place && !label.needed) continue;
    const [left, middle] = place ?? placesAt(label, AWAY, width)[0];
    const row = rowOf(middle);
    if (!taken.has(row)) taken.set(row, []);
    taken.get(row)?.push([left, middle, width]);
    found.push({ label, left, middle, far: times > 1 });
  }
  return found;
}

/** Left ends and middles of a text so far around its target. */
function placesAt(/** @type {Label} */ { x, y }, /** @type {number} */ away, width) {
  return [
    [x + away, y - away],
    [x + away, y + away],
    [x - away - width, y - away],
    [x - away - width, y + away],
  ];
}

function apart(/** @type {number[]} */ [otherLeft, otherMiddle, otherWidth], left, middle, width) {
  return (
    left > otherLeft + otherWidth ||
    otherLeft > left + width ||
    Math.abs(middle - otherMiddle) > HEIGHT
  );
}
