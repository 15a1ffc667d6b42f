// The tracker's settings of AIS in their form, and the button that wakes the selected ship.

import { element, say } from './panel.js';
import { settingsSay } from './ship_words.js';
import { ACTIVATED, JOINED } from './ships.js';

const form = () => /** @type {HTMLFormElement} */ (element('ais'));
const box = (/** @type {string} */ name) => /** @type {any} */ (form().elements.namedItem(name));

/** The tracker's settings into their form, unless somebody is in it. */
export function fillSettings(/** @type {Record<string, any>} */ ais) {
  if (form().contains(document.activeElement)) return;
  for (const [name, value] of Object.entries(ais)) {
    if (!name.startsWith('ais_')) continue;
    const field = box(name.slice(4));
    if (field instanceof HTMLInputElement && field.type === 'checkbox') field.checked = value;
    else if (field) field.value = value;
    else tick(name.slice(4), value);
  }
}

/** Words of a parameter as ticks. */
function tick(/** @type {string} */ group, value) {
  const words = String(value).split(' ');
  for (const one of ticks(group)) one.checked = words.includes(one.value);
}

const ticks = (/** @type {string} */ group) =>
  /** @type {HTMLInputElement[]} */ ([...form().querySelectorAll(`[data-group=${group}] input`)]);

/** What the form asks for, as the command `ais`. */
export function asked() {
  const words = (/** @type {string} */ group) =>
    ticks(group)
      .filter((one) => one.checked)
      .map((one) => one.value)
      .join(' ');
  const numbers = ['range_nm', 'cpa_nm', 'activation_range_nm', 'lost_range_nm'];
  const flags = ['lost_alarm', 'sleeping_danger', 'join'];
  return {
    symbol: box('symbol').value,
    kinds: words('kinds'),
    activation: words('activation'),
    ...Object.fromEntries(numbers.map((name) => [name, Number(box(name).value)])),
    ...Object.fromEntries(flags.map((name) => [name, box(name).checked ? 1 : 0])),
  };
}

/** The summary over the form, and the button that wakes the selected ship. */
export function showAis(/** @type {import('./app.js').App} */ app, ship) {
  say(element('ais-is'), settingsSay(app.state, app.settings));
  const button = /** @type {HTMLButtonElement} */ (element('awake'));
  button.hidden = !ship || ship.state === JOINED;
  button.disabled = !app.state.role.commands;
  say(button, ship?.shown === ACTIVATED ? 'To sleep' : 'Activate');
}

export function listen(/** @type {import('./app.js').App} */ app) {
  element('awake').addEventListener('click', () => {
    const { ship } = app.chosen();
    if (!ship) return;
    app.command('ais_awake', { mmsi: ship.mmsi, awake: ship.shown === ACTIVATED ? 0 : 1 });
  });
  form()
    .querySelector('.submit')
    ?.addEventListener('click', () => form().requestSubmit());
  form().addEventListener('submit', (event) => {
    event.preventDefault();
    app.command('ais', asked());
  });
}
