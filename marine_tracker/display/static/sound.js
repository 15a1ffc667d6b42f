// The alarms' sound: three short tones each 7 s while an alarm waits for somebody, two lower ones for
// a warning each time the tracker says that it sounds. Cautions are silent. The tracker knows what is
// silenced; a viewer that may not command can silence this device alone for 30 s.

const AGAIN_S = 7;
const SILENT_S = 30;
const TONE_HZ = { alarm: 880, warning: 660 };
const TONES = { alarm: 3, warning: 2 };

const sounds = (/** @type {Record<string, any>} */ alarm) =>
  alarm.state === 'active unacknowledged';
/** An alert, and which of its times to sound this is. */
const key = (alarm) => `${alarm.name} ${alarm.instance ?? 0} ${alarm.sounds ?? 0}`;

export class Sound {
  constructor() {
    /** @type {AudioContext|null} */
    this.context = null;
    this.known = new Set();
    this.last = -Infinity; // s, of the last sound
    this.until = -Infinity; // s, silenced
    this.played = 0;
  }

  /** To be called often; alarms as the server tells them, now in s. */
  update(/** @type {Record<string, any>[]} */ alarms, /** @type {number} */ now) {
    const waiting = alarms.filter(sounds);
    const fresh = waiting.filter((alarm) => !this.known.has(key(alarm)));
    this.known = new Set(waiting.map(key));
    const loud = fresh.some((alarm) => alarm.priority === 'alarm');
    if (loud) this.until = -Infinity;
    if (now < this.until) return;
    const again = now - this.last >= AGAIN_S && waiting.some((alarm) => alarm.priority === 'alarm');
    if (loud || again) this.play('alarm', now);
    else if (fresh.some((alarm) => alarm.priority === 'warning')) this.play('warning', now);
  }

  silence(/** @type {number} */ now) {
    this.until = now + SILENT_S;
  }

  play(/** @type {string} */ priority, /** @type {number} */ now) {
    this.last = now;
    this.played++;
    // Made after the first click: browsers keep a page quiet until then.
    this.context ??= new AudioContext();
    const begin = this.context.currentTime;
    for (let k = 0; k < TONES[priority]; k++) {
      const tone = new OscillatorNode(this.context, { frequency: TONE_HZ[priority] });
      const loudness = new GainNode(this.context, { gain: 0.2 });
      tone.connect(loudness).connect(this.context.destination);
      tone.start(begin + 0.3 * k);
      tone.stop(begin + 0.3 * k + 0.15);
    }
  }
}
