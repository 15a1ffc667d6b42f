// When to draw: at the next frame for whoever does something, for news only as often as this machine
// keeps up with, and now and then in any case.

const LEAST_MS = 250; // echoes fade, dangers flash
const SHARE = 3; // of the time one part for news, the rest for whoever does something
const FRAME_MS = 17;

export class Pace {
  constructor() {
    this.asked = true;
    this.fresh = false;
    this.drawn = -Infinity; // ms
    this.last = 0; // ms, of the last frame, drawn or not
    this.cost = 0; // ms that a drawing takes, by how late the frame after it came
  }

  /** Somebody waits for it. */
  ask() {
    this.asked = true;
  }

  /** Something came from the server. */
  news() {
    this.fresh = true;
  }

  /** Whether to draw in this frame; to be called in each of them. */
  due(/** @type {number} */ now) {
    if (this.drawn === this.last) {
      this.cost += 0.3 * (Math.max(now - this.drawn - FRAME_MS, 0) - this.cost);
    }
    this.last = now;
    const since = now - this.drawn;
    const due = this.asked || (this.fresh && since >= SHARE * this.cost) || since >= LEAST_MS;
    if (due) {
      this.asked = this.fresh = false;
      this.drawn = now;
    }
    return due;
  }
}
