// What a demo shows, and the choice of something else: there only where a demo runs.

import { element, say } from './panel.js';

const RATES = [0.5, 1, 2, 5, 10, 25];

const field = (/** @type {string} */ name) =>
  /** @type {HTMLSelectElement} */ (
    /** @type {HTMLFormElement} */ (element('demo')).elements.namedItem(name)
  );

/** Called by Set. */
export function listen(/** @type {import('./app.js').App} */ app) {
  const form = /** @type {HTMLFormElement} */ (element('demo'));
  const submit = /** @type {HTMLElement} */ (form.querySelector('.submit'));
  submit.addEventListener('click', () => form.requestSubmit());
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    const [kind, name] = JSON.parse(field('what').value);
    const { scenario } = app.state.demo;
    app.command('show', {
      scenario: kind === 'scenario' ? name : scenario,
      recording: kind === 'recording' ? name : '',
      rate: Number(field('rate').value),
    });
  });
}

let shown = '';

/** The choices, and of them what is shown now; a choice that somebody is making is left alone. */
export function showDemo(/** @type {import('./state.js').State} */ { demo }) {
  const now = JSON.stringify(demo);
  if (now === shown) return;
  shown = now;
  element('demo-box').hidden = !demo.scenarios;
  if (!demo.scenarios) return;
  say(element('demo-is'), `${demo.recording || demo.scenario}, ${demo.rate} x`);
  const { recording, recordings, scenario, scenarios } = demo;
  fill(
    field('what'),
    JSON.stringify(recording ? ['recording', recording] : ['scenario', scenario]),
    [
      ...recordings.map((name) => [JSON.stringify(['recording', name]), `recorded: ${name}`]),
      ...scenarios.map((name) => [JSON.stringify(['scenario', name]), name]),
    ],
  );
  const rates = [...new Set([...RATES, demo.rate])].sort((a, b) => a - b);
  fill(
    field('rate'),
    String(demo.rate),
    rates.map((rate) => [String(rate), `${rate} x`]),
  );
}

function fill(
  /** @type {HTMLSelectElement} */ select,
  /** @type {string} */ chosen,
  /** @type {string[][]} */ choices,
) {
  select.replaceChildren(
    ...choices.map(([value, text]) => new Option(text, value, false, value === chosen)),
  );
}
