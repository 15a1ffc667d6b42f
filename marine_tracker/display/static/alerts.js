// The alerts, in the order of the server, and the history of those that are settled.

import * as format from './format.js';
import { element, say } from './panel.js';
import { waits } from './state.js';

const MOST_PAST = 50;
const SAID = {
  'active unacknowledged': '',
  'active silenced': 'silenced',
  'active acknowledged': 'acknowledged',
  'rectified unacknowledged': 'over',
};

/** @param {import('./app.js').App} app */
export function showAlerts(app) {
  const { state } = app;
  const list = element('alarms');
  const old = new Map([...list.children].map((item) => [item.dataset.key, item]));
  const items = state.alarms.map((alarm) => {
    const key = `${alarm.name} ${alarm.instance ?? 0}`;
    const item = old.get(key) ?? newItem(key, alarm.name);
    item.className = `${alarm.priority} ${alarm.state}`;
    const [icon, text, button] = item.children;
    Object.assign(icon, {
      type: alarm.priority,
      active: !alarm.state.startsWith('rectified'),
      acknowledged: !waits(alarm),
      silenced: alarm.state === 'active silenced',
    });
    const said = SAID[alarm.state];
    say(text, `${said ? `${said}: ` : ''}${alarm.text || alarm.name}`);
    item.title = alarm.identifier
      ? `Alert ${alarm.identifier}-${alarm.instance}, category ${alarm.category}`
      : '';
    button.hidden = !waits(alarm);
    button.disabled = !state.role.commands;
    button.onclick = () =>
      alarm.instance
        ? app.command('acknowledge_alert', { instance: alarm.instance })
        : app.command('acknowledge', { number: alarm.number });
    return item;
  });
  if (items.length !== list.children.length || items.some((item, k) => item !== list.children[k])) {
    list.replaceChildren(...items);
  }
  showPast(state.settled);
}

function newItem(/** @type {string} */ key, /** @type {string} */ name) {
  const item = document.createElement('li');
  item.dataset.key = key;
  const button = document.createElement('obc-button');
  button.textContent = 'Ack';
  button.title = `Acknowledge ${name}`;
  item.append(document.createElement('obc-alert-icon'), document.createElement('span'), button);
  return item;
}

function showPast(/** @type {Record<string, any>[]} */ settled) {
  say(element('past-count'), String(settled.length));
  const list = element('past');
  const lines = settled.slice(0, MOST_PAST).map((alarm) => {
    const time = (at) => (at === null ? format.NONE : format.clock(at));
    const seen =
      alarm.acknowledged === null ? 'never acknowledged' : `ack ${time(alarm.acknowledged)}`;
    return `${time(alarm.raised)} ${alarm.priority}: ${alarm.text || alarm.name} (${seen}, over ${time(alarm.ended)})`;
  });
  while (list.children.length > lines.length) list.lastChild?.remove();
  lines.forEach((line, k) =>
    say(list.children[k] ?? list.appendChild(document.createElement('li')), line),
  );
}
