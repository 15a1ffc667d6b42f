// The buttons below and beside the picture: what they say, and what they do.

import { element, say } from './panel.js';
import { duration } from './format.js';
import { next } from './settings.js';

/** Names in colours.css that the picture is drawn with. */
const COLORS =
  'sea ring scale echo trail target coasting danger lost label own selected cursor marker safe area';

/** The palette's colours, and the words on the buttons, as the settings are. */
export function applySettings(/** @type {import('./app.js').App} */ app) {
  const { settings } = app;
  document.documentElement.dataset.obcTheme = settings.palette;
  const style = getComputedStyle(document.documentElement);
  app.colors = Object.fromEntries(
    COLORS.split(' ').map((name) => [name, style.getPropertyValue(`--${name}`).trim()]),
  );
  const words = {
    orientation: settings.orientation,
    motion: `${settings.motion} motion`,
    vectors: `Vectors ${settings.vectors}`,
    vectorMinutes: `${settings.vectorMinutes} min`,
    trails: `Trails ${settings.trails}`,
    trailMinutes: duration(settings.trailMinutes),
    offCentre: `Off centre ${settings.offCentre}`,
    rings: `Rings ${settings.rings}`,
    areas: `Danger areas ${settings.areas}`,
    safeCourses: `Safe courses ${settings.safeCourses}`,
    ellipses: `Ellipses ${settings.ellipses}`,
    labels: `Numbers ${settings.labels}`,
    ships: `AIS ${settings.ships}`,
    palette: settings.palette,
    sound: `Sound ${settings.sound}`,
  };
  for (const button of document.querySelectorAll('[data-next]')) {
    say(button, words[/** @type {HTMLElement} */ (button).dataset.next]);
  }
  app.redraw();
}

/** Every button gets what it does. */
export function listen(/** @type {import('./app.js').App} */ app) {
  for (const button of document.querySelectorAll('[data-next]')) {
    const name = /** @type {HTMLElement} */ (button).dataset.next;
    button.addEventListener('click', () => app.change(name, next(app.settings, name)));
  }
  for (const [id, act] of Object.entries({
    nearer: () => app.zoom(-1),
    farther: () => app.zoom(1),
    silence: app.silence,
    mark: app.mark,
    measure: app.measure,
    why: app.why,
    'reset-view': app.resetView,
    'no-heading-line': () => app.hide('heading'),
    'no-graphics': () => app.hide('graphics'),
    acquire: app.acquire,
    cancel: app.cancel,
    'acknowledge-all': () => app.command('acknowledge_all'),
    'trial-off': () => app.command('trial_off'),
  })) {
    element(id).addEventListener('click', act);
  }
}
