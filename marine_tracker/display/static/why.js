// The answer to "why is there no target here?": reasons in words, the deciding ones first.

import { element } from './panel.js';

/** Each line of an answer is a reason. */
export function showWhy(/** @type {{ok: boolean, text: string}} */ { ok, text }) {
  const items = text.split('\n').map((reason) => {
    const item = document.createElement('li');
    item.textContent = ok ? reason : `No answer: ${reason}`;
    return item;
  });
  element('why-says').replaceChildren(...items);
  const box = /** @type {HTMLDetailsElement} */ (element('why-box'));
  box.open = true;
  box.scrollIntoView({ block: 'nearest' });
}
