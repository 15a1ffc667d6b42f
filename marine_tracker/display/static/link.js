// The connection to the server: comes back by itself, and tells what came of each command.

const SILENT_MS = 6000; // without a word: the connection is dead, whatever it says itself
const LATE_S = 6; // behind by so much: what waits in the network is given up for the state of now
const LATE_AGAIN_MS = 15000; // and not again before
const AGAIN_MS = [500, 1000, 2000, 4000];

export class Link {
  /**
   * @param {string} token  '' to look only
   * @param {(message: Record<string, any>) => void} onMessage
   * @param {() => void} onOpen
   * @param {() => number} lateness  s that the last message was late
   */
  constructor(token, onMessage, onOpen, lateness = () => 0) {
    this.token = token;
    this.onMessage = onMessage;
    this.onOpen = onOpen;
    this.lateness = lateness;
    this.failures = 0;
    this.heard = 0;
    this.opened = 0;
    this.nextId = 1;
    /** @type {Map<number, (answer: {ok: boolean, text: string}) => void>} */
    this.waiting = new Map();
    /** @type {WebSocket|null} */
    this.socket = null;
    setInterval(() => this.watch(), 1000);
    this.connect();
  }

  connect() {
    const socket = new WebSocket(
      `${location.protocol.replace('http', 'ws')}//${location.host}/live`,
    );
    this.socket = socket;
    this.heard = this.opened = performance.now();
    socket.onopen = () => {
      this.onOpen();
      if (this.token) socket.send(JSON.stringify({ command: 'login', token: this.token }));
    };
    socket.onmessage = (event) => {
      this.heard = performance.now();
      this.failures = 0;
      const message = JSON.parse(event.data);
      if (message.kind === 'answer') this.answered(message);
      else this.onMessage(message);
    };
    socket.onclose = () => {
      if (this.socket === socket) this.again();
    };
  }

  /** A connection that died without a word is given up, and a new one made. */
  watch() {
    const now = performance.now();
    const late = this.lateness() > LATE_S && now - this.opened > LATE_AGAIN_MS;
    if (this.socket && (late || now - this.heard > SILENT_MS)) {
      this.socket.onclose = null;
      this.socket.close();
      this.again();
    }
  }

  again() {
    this.socket = null;
    for (const tell of this.waiting.values()) tell({ ok: false, text: 'the connection was lost' });
    this.waiting.clear();
    setTimeout(() => this.connect(), AGAIN_MS[Math.min(this.failures++, AGAIN_MS.length - 1)]);
  }

  /**
   * @param {string} command @param {Record<string, number>} [values]
   * @returns {Promise<{ok: boolean, text: string}>}
   */
  send(command, values = {}) {
    if (!this.socket || this.socket.readyState !== WebSocket.OPEN) {
      return Promise.resolve({ ok: false, text: 'no connection' });
    }
    const id = this.nextId++;
    this.socket.send(JSON.stringify({ command, id, ...values }));
    return new Promise((resolve) => this.waiting.set(id, resolve));
  }

  answered(/** @type {Record<string, any>} */ message) {
    const tell = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    tell?.({ ok: message.ok, text: message.text });
  }
}
