// What the page knows: the newest message of each kind, and how old each is.
//
// Receiving does not draw. Ages come from the server's steady clock, which stands in every
// message, and this browser's own steady clock: what time of day either has does not matter.

import { readShips } from './ships.js';
import { takeSpokes } from './spokes.js';

export const SILENT_S = 3; // without fresh data for so long: the red cross
const GLOW_SCANS = 12; // of plots that are kept for the afterglow
const MOST_SECTORS = 64; // messages of plots that make a scan
const DRIFT = 1e-4; // of two steady clocks against each other, at most

export const ACQUIRING = 0;
export const COASTING = 2;
export const LOST = 3;
export const ACKNOWLEDGED = 1;
export const UNACKNOWLEDGED = 2;

/**
 * @typedef {Record<string, any>} Message
 * @typedef {Record<string, any>} Target  one row of `targets`
 * @typedef {object} State
 * @property {Message|null} own
 * @property {Target[]} targets
 * @property {[number, number, number][]} fixed  stationary objects: number, x, y
 * @property {Target[]} ships      of AIS (ships.js)
 * @property {Message|null} ais      the tracker's settings of AIS
 * @property {Message|null} scan     the message that the targets came with, without its columns
 * @property {Message[]} plots       of the last scans, newest last
 * @property {any} spokes           radar video of the last turn (spokes.js)
 * @property {Message[]} alarms      in the order in which they are listed
 * @property {Message[]} settled     alerts that are over, the newest first
 * @property {Message|null} areas    of danger, while they are asked for
 * @property {Message|null} ship     own ship's size, and what the picture comes from
 * @property {Message|null} trails
 * @property {Message} trial
 * @property {Record<string, Message>} health
 * @property {Message|null} limits
 * @property {Message} zones         of the tracker, in m and rad; `error` where they are not known
 * @property {Record<string, any>} demo  what a demo shows and offers; empty where there is none
 * @property {{commands: boolean, why: string}} role
 * @property {number} heard          s of this browser's clock; -Infinity before the first message
 * @property {number} clockError     s, how far this browser's time of day is ahead of the server's
 * @property {number} offset         s, the server's steady clock less this browser's
 * @property {number} late           s that the last message was longer on its way than the quickest
 */

/** @returns {State} */
export function emptyState() {
  return {
    own: null,
    targets: [],
    fixed: [],
    ships: [],
    ais: null,
    scan: null,
    plots: [],
    spokes: null,
    alarms: [],
    settled: [],
    areas: null,
    ship: null,
    trails: null,
    trial: { on: false },
    health: {},
    limits: null,
    zones: { zones: [], error: '' },
    demo: {},
    role: { commands: false, why: '' },
    heard: -Infinity,
    offset: -Infinity,
    late: 0,
    clockError: 0,
  };
}

/**
 * Take a message in.
 * @param {State} state @param {Message} message @param {number} local s of this browser's clock
 */
export function receive(state, message, local) {
  // The message that was least on its way tells the server's time best. However long others wait
  // in a slow network after it: their age is not forgotten.
  const difference = message.now - local;
  const held = state.offset - DRIFT * Math.max(local - state.heard, 0);
  state.offset = Math.max(Number.isFinite(held) ? held : difference, difference);
  state.late = state.offset - difference;
  state.heard = local;
  switch (message.kind.replace(/\d+$/, '')) {
    case 'targets':
      state.targets = rows(message.columns);
      state.fixed = message.fixed ?? [];
      state.scan = {
        at: message.at,
        time: message.time,
        period: message.period,
      };
      break;
    case 'ships':
      state.ships = readShips(rows(message.columns), message);
      break;
    case 'plots':
      takePlots(state, message);
      break;
    case 'spokes':
      takeSpokes(state, message);
      break;
    case 'alarms':
      state.alarms = message.alarms;
      break;
    case 'alarms_past':
      state.settled = message.alarms;
      break;
    case 'demo':
      if (state.demo.run !== undefined && message.demo.run !== state.demo.run) {
        Object.assign(state, {
          targets: [],
          ships: [],
          scan: null,
          plots: [],
          spokes: null,
          trails: null,
        }); // another run
      }
      state.demo = message.demo;
      break;
    case 'health':
      state.health = message.parts;
      break;
    case 'role':
      state.role = { commands: message.commands, why: message.why };
      break;
    case 'pulse':
      state.clockError = Date.now() / 1000 - message.utc || 0;
      break;
    case 'own':
      state.own = { wx: message.vx, wy: message.vy, stabilised: 'ground', ...message };
      break;
    case 'trails':
    case 'trial':
    case 'limits':
    case 'ship':
    case 'areas':
    case 'ais':
    case 'zones':
      state[message.kind] = message;
      break;
  }
}

/** Of each radar the newest scans; where its time goes back, it is another run. */
function takePlots(/** @type {State} */ state, /** @type {Message} */ message) {
  const radar = message.radar ?? 0;
  const of = state.plots.filter((scan) => (scan.radar ?? 0) === radar);
  if (of.length && message.stamp < of[of.length - 1].stamp) state.plots = [];
  else if (of.length >= GLOW_SCANS * sectors(state, of)) {
    state.plots.splice(state.plots.indexOf(of[0]), 1);
  }
  state.plots.push(message);
}

/**
 * Messages of one radar's plots in the time between two messages of targets: 1, or its sectors.
 * @param {State} state @param {Message[]} of
 */
function sectors(state, of) {
  const period = state.scan?.period ?? 0;
  const gap = of.length > 1 ? (of[of.length - 1].stamp - of[0].stamp) / (of.length - 1) : 0;
  return gap > 0 ? Math.min(Math.max(Math.round(period / gap), 1), MOST_SECTORS) : 1;
}

/** After a new connection the clocks are compared anew: it may be another server. */
export function reconnected(/** @type {State} */ state) {
  state.offset = -Infinity;
  state.late = 0;
}

/**
 * The server's time now, s.
 * @param {State} state @param {number} local s
 */
export function serverNow(state, local) {
  return local + state.offset;
}

/**
 * Why the picture is not live, or '' while it is.
 * @param {State} state @param {number} local s
 */
export function staleness(state, local) {
  if (!Number.isFinite(state.heard)) return 'No connection yet';
  const silent = local - state.heard;
  if (silent >= SILENT_S) return `No connection for ${Math.floor(silent)} s`;
  if (state.late >= SILENT_S) return `The network is ${Math.floor(state.late)} s late`;
  const now = serverNow(state, local);
  if (!state.own) return 'No own ship yet';
  const ownAge = now - state.own.at;
  if (ownAge >= SILENT_S) return `No own ship for ${Math.floor(ownAge)} s`;
  if (!state.scan) return 'No targets yet: waiting for the tracker';
  const overdue = now - state.scan.at - (state.scan.period ?? 0);
  if (overdue >= SILENT_S) return `No scan for ${Math.floor(now - state.scan.at)} s`;
  return '';
}

/** The columns of a message as rows. @returns {Target[]} */
function rows(/** @type {Record<string, any[]>} */ columns) {
  const names = Object.keys(columns);
  const first = columns[names[0]] ?? [];
  return first.map((_, row) => Object.fromEntries(names.map((name) => [name, columns[name][row]])));
}

/** TT07; Q and the track's id while it is being acquired. @param {Target} target */
export function nameOf(target) {
  return target.number ? `TT${String(target.number).padStart(2, '0')}` : `Q${target.id}`;
}

/** Whether somebody has still to acknowledge an alert. @param {Message} alarm */
export const waits = (alarm) =>
  alarm.state.endsWith('unacknowledged') || alarm.state === 'active silenced';

/** Alerts that somebody has still to acknowledge. @param {State} state */
export function unacknowledged(state) {
  return state.alarms.filter(waits);
}

/** Numbers of the targets in guard zones that nobody has acknowledged. @param {State} state */
export function newTargets(state) {
  const found = state.alarms.filter((alarm) => alarm.kind === 'new target' && waits(alarm));
  return new Set(found.map((alarm) => alarm.number));
}

/** Where targets were lost, until that is acknowledged. @param {State} state */
export function lostTargets(state) {
  return state.alarms.filter(
    (alarm) => alarm.kind === 'lost target' && alarm.x !== null && alarm.y !== null,
  );
}
