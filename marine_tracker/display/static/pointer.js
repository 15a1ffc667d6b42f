// Mouse and finger on the picture.

import * as forms from './forms.js';

const at = (/** @type {MouseEvent} */ event) =>
  /** @type {[number, number]} */ ([event.offsetX, event.offsetY]);

export function listen(/** @type {import('./app.js').App} */ app) {
  const { canvas, marks, state, settings } = app;
  let dragged = false; // own ship's vector, by the last press
  canvas.addEventListener('pointerdown', (event) => {
    const handle = forms.handleOf(state, settings, app.scopeNow().view);
    marks.drag = state.role.commands && forms.grips(handle, at(event)) ? at(event) : null;
    dragged = false;
    if (marks.drag) canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener('pointermove', (event) => {
    app.pointer = at(event);
    app.redraw();
    if (!marks.drag) return;
    dragged = true;
    marks.drag = app.pointer;
    forms.dragTo(state, settings, app.scopeNow().view, app.pointer);
  });
  canvas.addEventListener('pointerup', () => {
    if (marks.drag && dragged) forms.tryIt();
    marks.drag = null;
  });
  canvas.addEventListener('pointerleave', () => {
    app.pointer = null;
    app.redraw();
  });
  canvas.addEventListener('click', (event) => {
    if (!dragged) app.selectAt(...at(event));
  });
  canvas.addEventListener('dblclick', (event) => {
    app.selectAt(...at(event));
    if (marks.id === null) app.acquire();
  });
  canvas.addEventListener('wheel', (event) => app.zoom(Math.sign(event.deltaY)), {
    passive: true,
  });
}
