// What the modules of the page share: main.js makes it, the others get it.

/**
 * @typedef {object} App
 * @property {import('./state.js').State} state        what the server told
 * @property {import('./settings.js').Settings} settings  what the viewer chose
 * @property {import('./surround.js').Marks} marks     what the viewer marked
 * @property {import('./sound.js').Sound} sound
 * @property {HTMLCanvasElement} canvas
 * @property {[number, number]|null} pointer           px, while it is over the picture
 * @property {Record<string, string>} colors           of the palette, by the names in colours.css
 * @property {() => import('./picture.js').Scope} scopeNow  how the map lies on the screen now
 * @property {() => void} redraw                       at the next frame
 * @property {(name: string, value: any) => void} change    one of the settings
 * @property {(some: object) => void} choices         several settings at once
 * @property {import('./scope.js').Held} held
 * @property {((place: number[]) => void)|null} asking  who waits for the next click
 * @property {(step: number) => void} zoom             to the next range; -1 is nearer
 * @property {(name: string, values?: object) => Promise<{ok: boolean, text: string}>} command  what came
 *     of it is told as well
 * @property {(text: string, ms?: number) => void} tell   words over the picture, for some seconds
 * @property {(id: number|null) => void} choose        a target's track, or none
 * @property {() => ReturnType<typeof import('./ships.js').selection>} chosen
 * @property {(x: number, y: number) => void} selectAt  what lies at a pixel; the cursor goes there
 * @property {() => void} acquire                      at the cursor
 * @property {() => void} cancel                       the chosen target
 * @property {() => void} silence                      what sounds, for 30 s
 * and the actions of actions.js
 */

/** Seconds of this browser's steady clock. */
export const seconds = () => performance.now() / 1000;
