// What keys and buttons do on the picture, beside settings and commands.

import { rangeBearing, toMap, toScreen } from './geometry.js';
import { seconds } from './app.js';
import { putOwnShip, resetAnchor } from './scope.js';
import { markNext } from './tools.js';
import { showWhy } from './why.js';

const HIDDEN_S = 3; // that the heading line, or all graphics, are off

/** The actions of a page, as parts of its App. */
export function actions(/** @type {any} */ app) {
  const { state, settings, marks, held } = app;
  return {
    /** The cursor's place, or the mouse's; null where there is neither. */
    here: () => marks.cursor ?? (app.pointer && toMap(app.scopeNow().view, ...app.pointer)),

    /** A bearing line with a range marker at the cursor; after two of them, none. */
    mark() {
      const place = app.here();
      if (!place || !state.own) app.tell('Click where the marker shall be, then press e.');
      else markNext(marks.tools, place, state.own);
      app.redraw();
    },

    /** The next click, or Enter at the cursor, goes to take(place); Escape ends it. */
    ask(/** @type {string} */ words, /** @type {(place: number[]) => void} */ take) {
      app.asking = take;
      app.tell(`${words} (or Enter at the cursor; Escape ends)`, Infinity);
    },
    stopAsking() {
      if (app.asking) app.tell('');
      app.asking = null;
    },

    /** Between two points; again: nothing. */
    measure() {
      const { tools } = marks;
      if (tools.measure.length || app.asking) {
        tools.measure = [];
        app.stopAsking();
      } else {
        app.ask('Click the first point', (first) => {
          tools.measure = [first];
          app.ask('Click the second point', (second) => {
            tools.measure = [first, second];
            const [range] = rangeBearing(first[0], first[1], second[0], second[1]);
            app.tell(`Measured: ${(range / 1852).toFixed(3)} NM, see the corner`);
          });
        });
      }
      app.redraw();
    },

    /** Why is there no target? At the next click. */
    why() {
      app.ask('Click where you miss a target', app.whyAt);
    },
    async whyAt([x, y]) {
      marks.asked = [x, y];
      showWhy(await app.command('explain', { x, y }));
    },

    /** Own ship to a pixel, at most so far from the middle. */
    putOwnShip(pixel) {
      const { settings: changed, anchor, all } = putOwnShip(app.scopeNow(), held, pixel);
      if (anchor) held.anchor = anchor;
      if (!all) app.tell('Own ship is 75 % of the radius off centre: farther she does not go.');
      app.choices(changed);
    },
    ownShipHere() {
      const place = app.here();
      if (place) app.putOwnShip(toScreen(app.scopeNow().view, ...place));
      else app.tell('Click where own ship shall be, then press b.');
    },
    /** Own ship to the middle; in true motion behind it again. */
    resetView() {
      if (held.anchor && state.own) held.anchor = resetAnchor(state.own, settings);
      else app.choices({ offCentre: 'off' });
      app.redraw();
    },

    /** The heading line, or all graphics, are off for a moment: they come back by themselves. */
    hide(/** @type {'heading'|'graphics'} */ what) {
      marks.hidden[what] = seconds() + HIDDEN_S;
      app.redraw();
    },
  };
}
