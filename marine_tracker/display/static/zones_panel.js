// Zones beside the picture: the list, and the form of the one that is drawn or changed. What is
// saved goes to the tracker's parameter; what comes back from it is what all viewers see.

import { NAUTICAL_MILE, degrees, radians, toMap, toScreen, wrap } from './geometry.js';
import { element, say } from './panel.js';
import { radiusOf } from './scope.js';
import * as zones from './zones.js';

/** @typedef {import('./app.js').App} App */

const form = () => /** @type {HTMLFormElement} */ (element('zone'));
const fields = () => /** @type {Record<string, HTMLInputElement>} */ (form().elements);

export function listen(/** @type {App} */ app) {
  for (const button of document.querySelectorAll('[data-zone]')) {
    const shape = /** @type {HTMLElement} */ (button).dataset.zone;
    button.addEventListener('click', () => begin(app, shape));
  }
  form().addEventListener('input', () => take(app));
  form().addEventListener('submit', (event) => {
    event.preventDefault();
    save(app);
  });
  for (const [id, act] of Object.entries({
    'zone-save': () => form().requestSubmit(),
    'zone-leave': () => edit(app, null),
    'zone-corner': () => addCorner(app),
    'zone-uncorner': () => removeCorner(app),
  })) {
    element(id).addEventListener('click', act);
  }
}

/** The list of zones, and whether the form is open. */
export function show(/** @type {App} */ app) {
  const { state, marks } = app;
  const { zones: known, error } = state.zones;
  say(element('zones-are'), error || `${known.length}`);
  const list = element('zones');
  const items = known.map((zone) => zone.name);
  if (list.dataset.names !== JSON.stringify(items)) {
    list.dataset.names = JSON.stringify(items);
    list.replaceChildren(...items.map((name) => item(app, name)));
  }
  known.forEach((zone, k) => {
    say(list.children[k].firstElementChild, `${zone.name}: ${zones.inWords(zone)}`);
  });
  for (const button of element('zones-box').querySelectorAll('button, obc-button')) {
    /** @type {HTMLButtonElement} */ (button).disabled = !state.role.commands;
  }
  if (marks.draft) fill(marks.draft.zone);
  form().hidden = !marks.draft;
}

function item(app, name) {
  const found = document.createElement('li');
  const button = (words, title, act) => {
    const made = document.createElement('obc-button');
    Object.assign(made, { textContent: words, title });
    made.addEventListener('click', act);
    return made;
  };
  const known = () => app.state.zones.zones.find((zone) => zone.name === name);
  found.append(
    document.createElement('span'),
    button('Change', `Change ${name}`, () => known() && edit(app, known(), name)),
    button('Delete', `Delete ${name}`, () => app.command('zone_delete', { name })),
  );
  return found;
}

function begin(app, shape) {
  const { state, settings } = app;
  if (!state.own) return app.tell('No own ship yet: a zone has no place.');
  const taken = state.zones.zones.map((zone) => zone.name);
  let number = taken.length + 1;
  while (taken.includes(`zone ${number}`)) number++;
  const far = radiusOf(settings);
  edit(app, zones.newZone(shape, 'guard', `zone ${number}`, far, state.own));
}

/** A zone into the form and onto the picture with its handles; null ends that. */
export function edit(app, zone, was = '') {
  app.marks.draft = zone && { zone: structuredClone(zone), was, handle: -1 };
  say(element('zone-says'), '');
  element('zones-box').toggleAttribute('open', true);
  show(app);
  app.redraw();
}

async function save(app) {
  const { draft } = app.marks;
  if (!draft) return;
  const { ok, text } = await app.command('zone_put', {
    zone: zones.toParameter(draft.zone),
    was: draft.was,
  });
  say(element('zone-says'), ok ? '' : text);
  if (!ok) return;
  // As drawn, until the tracker's word comes.
  const others = app.state.zones.zones.filter((zone) => zone.name !== draft.was);
  app.state.zones = { ...app.state.zones, zones: [...others, draft.zone] };
  edit(app, null);
}

/** What is typed goes into the zone. */
function take(app) {
  const { draft } = app.marks;
  if (!draft) return;
  const { name, kind, fixed, near, far, first, last } = fields();
  const typed = { ...draft.zone, name: name.value, kind: kind.value };
  const number = (input, old) => (input.value === '' ? old : Number(input.value));
  if (typed.range) {
    typed.range = [near, far].map(
      (one, k) => number(one, typed.range[k] / NAUTICAL_MILE) * NAUTICAL_MILE,
    );
  }
  if (typed.bearing) {
    const [from, width] = typed.bearing;
    const side = radians(number(first, degrees(from)));
    const end = radians(number(last, degrees(from + width)));
    typed.bearing = [wrap(side), wrap(end - side)];
  }
  draft.zone = zones.fixedTo(typed, fixed.value, app.state.own);
  app.redraw();
}

/** The zone goes into the fields, but not into the one that somebody types in. */
function fill(/** @type {zones.Zone} */ zone) {
  const { range, bearing, corners } = zone;
  const [near, far] = (range ?? [0, 0]).map((one) => (one / NAUTICAL_MILE).toFixed(3));
  const side = (angle) => String((Math.round(degrees(wrap(angle)) * 10) % 3600) / 10);
  const [first, width] = bearing ?? [0, 0];
  const values = { name: zone.name, kind: zone.kind, fixed: zone.fixed_to, near, far };
  const all = { ...values, first: side(first), last: side(first + width) };
  for (const [name, value] of Object.entries(all)) {
    const input = fields()[name];
    if (document.activeElement !== input && input.value !== value) input.value = value;
  }
  for (const [part, there] of [
    ['range', range],
    ['bearing', bearing],
    ['corners', corners],
  ]) {
    for (const one of form().querySelectorAll(`.of-${part}`)) one.hidden = !there;
  }
}

function addCorner(app) {
  const { draft } = app.marks;
  const place = app.here();
  if (!place) return app.tell('Click where the corner shall be.');
  draft.zone = zones.withCorner(draft.zone, place, app.state.own);
  app.redraw();
}

function removeCorner(app) {
  const { draft } = app.marks;
  if (draft.handle < 0) app.tell('Drag or choose the corner first (keys [ and ]).');
  else {
    draft.zone = zones.withoutCorner(draft.zone, draft.handle);
    draft.handle = -1;
  }
  app.redraw();
}

/**
 * What of the zone that is being changed lies at a pixel: a handle, or the whole of it.
 * @returns {((place: number[], own: any) => void)|null}
 */
export function zoneGrip(app, view, [px, py], reach) {
  const { draft } = app.marks;
  const own = app.state.own;
  if (!draft) return null;
  const handles = zones.handles(draft.zone, own);
  const away = handles.map(({ x, y }) => {
    const [hx, hy] = toScreen(view, x, y);
    return Math.hypot(hx - px, hy - py);
  });
  const nearest = away.indexOf(Math.min(...away));
  if (away[nearest] <= reach) {
    draft.handle = nearest;
    const { what } = handles[nearest];
    return (place, ship) => (draft.zone = zones.withHandle(draft.zone, what, place, ship));
  }
  let from = toMap(view, px, py);
  if (!zones.contains(draft.zone, from, own)) return null;
  draft.handle = -1;
  return (place, ship) => {
    draft.zone = zones.moved(draft.zone, from, place, ship);
    from = /** @type {[number, number]} */ (place);
  };
}

/** By keys: the next handle (-1 is the whole zone), or what is chosen by so many px. */
export function nextHandle(app, /** @type {number} */ step) {
  const { draft } = app.marks;
  if (!draft) return;
  const count = zones.handles(draft.zone, app.state.own).length + 1;
  draft.handle = ((draft.handle + 1 + step + count) % count) - 1;
  app.redraw();
}

export function moveHandle(app, /** @type {number} */ right, /** @type {number} */ down) {
  const { draft } = app.marks;
  const own = app.state.own;
  if (!draft || !own) return;
  const { view } = app.scopeNow();
  const handle = zones.handles(draft.zone, own)[draft.handle];
  const outline = zones.outline(draft.zone, own)[0];
  const from = handle ? [handle.x, handle.y] : outline[0];
  const [x, y] = toScreen(view, from[0], from[1]);
  const to = toMap(view, x + right, y + down);
  draft.zone = handle
    ? zones.withHandle(draft.zone, handle.what, to, own)
    : zones.moved(draft.zone, from, to, own);
  app.redraw();
}
