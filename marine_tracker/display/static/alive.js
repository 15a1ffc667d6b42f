// Whether the picture is live, told by a timer and not by messages: silence shows itself. The alarms'
// sound and the page's title go by it, too, in a hidden tab as well.

import { element, say } from './panel.js';
import { staleness, unacknowledged } from './state.js';

/**
 * @param {import('./app.js').App} app
 * @param {import('./layers.js').Surface} surface
 * @param {number} now s
 */
export function alive({ state, settings, sound }, surface, now) {
  if (settings.sound === 'on') sound.update(state.alarms, now);
  element('silence').hidden = settings.sound !== 'on';
  const why = surface.lost ? 'The picture was lost: drawn anew' : staleness(state, now);
  const stale = element('stale');
  stale.hidden = !why;
  if (why) say(stale.firstElementChild ?? stale.appendChild(document.createElement('span')), why);
  const count = unacknowledged(state).length;
  const title = count ? `(${count}) alarm${count > 1 ? 's' : ''} - PPI` : 'PPI';
  document.title = why ? 'NO LIVE DATA - PPI' : title;
}
