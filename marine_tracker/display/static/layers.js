// Layers of the picture that are drawn anew only where what they show has changed, and the surface
// that all is drawn on, which survives the loss of its drawing context.

/** A drawing kept off screen. */
export class Layer {
  constructor() {
    /** @type {OffscreenCanvas|null} */
    this.canvas = null;
    /** @type {OffscreenCanvasRenderingContext2D|null} */
    this.pen = null;
    this.key = '';
    this.drawn = 0;
  }

  /**
   * Put the layer onto a canvas of the same size; paint(pen) draws it in CSS pixels, and is called
   * only where the key is another one than the last time.
   * @param {CanvasRenderingContext2D} target  in CSS pixels
   * @param {unknown[]} parts  all that the drawing depends on, beside the size
   * @param {(pen: OffscreenCanvasRenderingContext2D) => void} paint
   */
  onto(target, parts, paint) {
    const { width, height } = target.canvas;
    const { a: ratio } = target.getTransform();
    const key = [width, height, ratio, ...parts].join(' ');
    if (key !== this.key || this.pen?.isContextLost?.()) {
      if (!this.canvas || !this.pen || this.pen.isContextLost?.()) {
        this.canvas = new OffscreenCanvas(width, height);
        this.pen = this.canvas.getContext('2d');
      }
      if (!this.pen) return; // no memory for it just now
      this.key = key;
      this.drawn++;
      this.canvas.width = width; // clears it, whatever the size
      this.canvas.height = height;
      this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      paint(this.pen);
    }
    target.save();
    target.setTransform(1, 0, 0, 1, 0, 0);
    target.drawImage(/** @type {OffscreenCanvas} */ (this.canvas), 0, 0);
    target.restore();
  }
}

const MOST_STAMPS = 300;

/** Small drawings that are made once and put down many times: a symbol costs a copy of its pixels. */
export class Stamps {
  constructor() {
    /** @type {Map<string, OffscreenCanvas>} */
    this.made = new Map();
  }

  /**
   * Put a drawing down at x, y, to the nearest pixel of the screen.
   * @param {CanvasRenderingContext2D} target  in CSS pixels
   * @param {string} key  says all that the drawing depends on
   * @param {number} x px @param {number} y px
   * @param {number} half  px, how far the drawing reaches from its middle
   * @param {(pen: CanvasRenderingContext2D, x: number, y: number) => void} draw
   */
  put(target, key, x, y, half, draw) {
    const { a: ratio } = target.getTransform();
    const name = `${key} ${ratio}`;
    const reach = Math.ceil(half * ratio);
    let stamp = this.made.get(name);
    if (!stamp) {
      if (this.made.size >= MOST_STAMPS) this.made.clear();
      stamp = new OffscreenCanvas(2 * reach, 2 * reach);
      const pen = /** @type {any} */ (stamp.getContext('2d'));
      if (!pen) return; // no memory for it just now
      pen.setTransform(ratio, 0, 0, ratio, reach, reach);
      draw(pen, 0, 0);
      this.made.set(name, stamp);
    }
    const left = Math.round(x * ratio) - reach;
    const top = Math.round(y * ratio) - reach;
    target.drawImage(stamp, left / ratio, top / ratio, (2 * reach) / ratio, (2 * reach) / ratio);
  }
}

/**
 * What the picture is drawn on: the canvas of the page, or, where its context was lost and did not
 * come back at once, a fresh one over it. The first one goes on taking what mouse and keys say.
 */
export class Surface {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.shown = canvas;
    this.pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  }

  /** Whether nothing of what is drawn shows at this moment. */
  get lost() {
    return this.pen.isContextLost?.() ?? false;
  }

  /** The pen of a canvas that can be drawn on, of the right size, in CSS pixels. */
  ready() {
    if (this.lost) {
      const fresh = document.createElement('canvas');
      fresh.className = 'fresh';
      fresh.ariaHidden = 'true';
      if (this.shown !== this.canvas) this.shown.remove();
      this.canvas.after(fresh);
      this.shown = fresh;
      this.pen = /** @type {CanvasRenderingContext2D} */ (fresh.getContext('2d'));
    }
    const ratio = window.devicePixelRatio || 1;
    const width = Math.round(this.canvas.clientWidth * ratio);
    const height = Math.round(this.canvas.clientHeight * ratio);
    if (this.shown.width !== width || this.shown.height !== height) {
      this.shown.width = width;
      this.shown.height = height;
    }
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    return this.pen;
  }
}
