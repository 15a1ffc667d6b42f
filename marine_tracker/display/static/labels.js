// Where labels stand: beside their targets, none over another.

/**
 * @typedef {object} Label
 * @property {number} x          px, of the target
 * @property {number} y
 * @property {string} text
 * @property {boolean} needed    shown even where there is no room (dangerous, selected)
 */

const HEIGHT = 14;
const AWAY = 11;

/**
 * The labels that find room, with the places of their left middles; those needed come first.
 * @param {Label[]} labels @param {(text: string) => number} widthOf px
 * @returns {{label: Label, left: number, middle: number}[]}
 */
export function placed(labels, widthOf) {
  /** @type {{label: Label, left: number, middle: number}[]} */
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
    const places = [
      [label.x + AWAY, label.y - AWAY],
      [label.x + AWAY, label.y + AWAY],
      [label.x - AWAY - width, label.y - AWAY],
      [label.x - AWAY - width, label.y + AWAY],
    ];
    const place = places.find(([left, middle]) => free(left, middle, width));
    if (!place && !label.needed) continue;
    const [left, middle] = place ?? places[0];
    const row = rowOf(middle);
    if (!taken.has(row)) taken.set(row, []);
    taken.get(row)?.push([left, middle, width]);
    found.push({ label, left, middle });
  }
  return found;
}

function apart(/** @type {number[]} */ [otherLeft, otherMiddle, otherWidth], left, middle, width) {
  return (
    left > otherLeft + otherWidth ||
    otherLeft > left + width ||
    Math.abs(middle - otherMiddle) > HEIGHT
  );
}
