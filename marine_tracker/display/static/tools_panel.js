// Bearing lines, range markers and index lines beside the picture: every value can be typed.

import { NAUTICAL_MILE, degrees, radians, wrap } from './geometry.js';
import { element } from './panel.js';
import { keep } from './settings.js';
import { lineThrough, originAt, reset, setRelative } from './tools.js';

/** @typedef {import('./app.js').App} App */

const REFERENCES = [
  ['true', 'True'],
  ['relative', 'Relative'],
];
const ORIGINS = [
  ['', 'Own ship'],
  ['ground', 'Cursor, fixed'],
  ['ship', 'Cursor, moving'],
];
/** @type {(() => void)[]} what brings the fields up to date */
const shown = [];

/** The page's box gets its rows. */
export function listen(/** @type {App} */ app) {
  const { tools } = app.marks;
  const box = element('tools-rows');
  tools.ebl.forEach((line, k) => {
    const name = `EBL${k + 1}`;
    row(box, app, name, line, [
      bearing(app, name, line),
      reference(app, name, line),
      origin(app, name, line),
    ]);
  });
  tools.vrm.forEach((marker, k) => {
    const name = `VRM${k + 1}`;
    const range = miles(app, `${name} range, NM`, marker, 'range', 0.001);
    row(box, app, name, marker, [range, origin(app, name, marker)]);
  });
  tools.lines.forEach((line, k) => {
    const name = `Line ${k + 1}`;
    row(box, app, name, line, [
      bearing(app, name, line),
      reference(app, name, line),
      miles(app, `${name} distance, NM to starboard, - to port`, line, 'distance', -96),
      miles(app, `${name} from, NM ahead; empty: whole`, line, 'from', -200, 'from'),
      miles(app, `${name} to, NM ahead; empty: whole`, line, 'to', -200, 'to'),
      button('At cursor', `${name} through the cursor`, () => {
        const place = app.here();
        if (place && app.state.own) lineThrough(line, place, app.state.own);
        line.on = true;
        app.redraw();
      }),
    ]);
  });
  // Index lines are there again when the page is opened the next time.
  for (const kind of ['change', 'click']) {
    box.addEventListener(kind, () => keep(tools.lines, 'lines'));
  }
  element('tools-reset').addEventListener('click', () => {
    reset(tools);
    app.redraw();
  });
}

/** Values that were changed on the picture into their fields, unless somebody types there. */
export function show() {
  if (!(/** @type {HTMLDetailsElement} */ (element('tools-box')).open)) return;
  for (const update of shown) update();
}

function row(box, app, name, tool, parts) {
  const found = document.createElement('div');
  found.className = 'tool';
  const label = document.createElement('label');
  const on = document.createElement('input');
  on.type = 'checkbox';
  on.addEventListener('change', () => {
    tool.on = on.checked;
    app.redraw();
  });
  shown.push(() => (on.checked = tool.on));
  label.append(on, ` ${name}`);
  found.append(label, ...parts);
  box.append(found);
}

/** A field for a number that is kept in another unit. */
function field(app, title, read, write, { step, low, high, empty = false, hint = '' }) {
  const input = document.createElement('input');
  Object.assign(input, { type: 'number', title, ariaLabel: title, step, min: low, max: high });
  input.placeholder = hint;
  input.addEventListener('change', () => {
    if (input.value === '' && empty) write(null);
    else if (input.value !== '' && input.checkValidity()) write(Number(input.value));
    else {
      const may = `${title}: a number from ${low} to ${high}${empty ? ', or empty' : ''}`;
      app.tell(`Not taken: ${may}`);
    }
    input.value = read();
    app.redraw();
  });
  shown.push(() => {
    if (document.activeElement !== input) input.value = read();
  });
  return input;
}

function bearing(app, name, tool) {
  return field(
    app,
    `${name} bearing, degrees`,
    () => (Math.round(degrees(wrap(tool.bearing)) * 10) % 3600) / 10,
    (value) => (tool.bearing = wrap(radians(value))),
    { step: 'any', low: 0, high: 360 },
  );
}

/** hint: what an empty field means; without it none may be empty */
function miles(app, title, tool, key, low, hint = '') {
  return field(
    app,
    title,
    () => (tool[key] === null ? '' : Math.round((1000 * tool[key]) / NAUTICAL_MILE) / 1000),
    (value) => (tool[key] = value === null ? null : value * NAUTICAL_MILE),
    { step: 'any', low, high: 200, empty: hint !== '', hint },
  );
}

function choice(title, choices, read, write) {
  const select = document.createElement('select');
  Object.assign(select, { title, ariaLabel: title });
  for (const [value, words] of choices) select.append(new Option(words, value));
  select.addEventListener('change', () => write(select.value));
  shown.push(() => (select.value = read()));
  return select;
}

function reference(app, name, tool) {
  return choice(
    `${name} from true north or from the bow`,
    REFERENCES,
    () => (tool.relative ? 'relative' : 'true'),
    (value) => {
      setRelative(tool, value === 'relative', app.state.own);
      app.redraw();
    },
  );
}

function origin(app, name, tool) {
  return choice(
    `${name} begins at`,
    ORIGINS,
    () => tool.origin?.with ?? '',
    (value) => {
      const place = app.here();
      if (value && !(place && app.state.own))
        app.tell('Click on the picture where it shall begin.');
      else tool.origin = originAt(value, place ?? [0, 0], app.state.own);
      app.redraw();
    },
  );
}

function button(words, title, act) {
  const found = document.createElement('button');
  Object.assign(found, { type: 'button', textContent: words, title });
  found.addEventListener('click', act);
  return found;
}
