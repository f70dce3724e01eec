// An ordered outbox in the browser's storage: what goes in is delivered once, in order, however
// often the network fails or the page is loaded again.

import { patiently, request } from "./api.js";
import { now, read, tenths, write } from "./storage.js";

const LATE_MS = 3000; // without an answer for so long, the participant is told
const MOST_EVENTS = 200; // in one message; the rest waits for the next

export class Outbox {
  #name;
  #participant;
  #on;
  #queue;
  #events;
  #took; // path of a delivered message -> how long it took until the server had it
  #waiting = new Map(); // key of a message -> who in this page waits for its reply
  #drained = [];
  #busy = false;
  #late = false;
  #closed = false;

  /**
   * `participant`: whose page this is, as every message says.
   * `on`: {late(), saved() after late, refused(error): the server will not take the first message}.
   */
  constructor(name, participant, on) {
    this.#name = name;
    this.#participant = participant;
    this.#on = on;
    const kept = read(name);
    this.#queue = kept?.queue ?? [];
    this.#events = kept?.events ?? [];
    this.#took = kept?.took ?? {};
  }

  /** Where the queued messages are to go, in order. */
  get waiting() {
    return this.#queue.map((message) => message.path);
  }

  /** Note an event at a time of this page's own clock; it travels with the next message. */
  log(type, details = {}, time = performance.now()) {
    this.#events.push({ type, client_time_ms: tenths(time), details });
    this.#keep();
  }

  /**
   * Queue a message; resolves with the server's reply once it has it. Where it follows `after`, the
   * path of an earlier one, it says how long that one took: it may have been slow on its way.
   */
  send(path, body, after = null) {
    const { key } = this.#add(path, body, after);
    const reply = new Promise((resolve) => this.#waiting.set(key, resolve));
    this.deliver();
    return reply;
  }

  /** The page is going: queue the events not yet told, and send them with its last breath. */
  sendLast(path, body) {
    if (this.#closed || !this.#events.length) return;
    const message = this.#add(path, body);
    if (this.#queue.length === 1) request(message.path, this.#sent(message)).catch(() => {});
  }

  /** Resolves when everything queued is delivered, also what was queued before a reload. */
  flush() {
    const drained = new Promise((resolve) => this.#drained.push(resolve));
    this.deliver();
    return drained;
  }

  /** Forget what is queued, but not its events: the server has moved on and will never take it. */
  drop() {
    this.#events.unshift(...this.#queue.flatMap((message) => message.body.events));
    this.#queue = [];
    this.#keep();
  }

  /** Another tab speaks for this participant from now on. */
  close() {
    this.#closed = true;
  }

  /** Work through the queue; called again after a refusal, it tries again. */
  async deliver() {
    if (this.#busy) {
      if (this.#late) this.#tellLate();
      return;
    }
    this.#busy = true;
    const timer = setTimeout(() => this.#tellLate(), LATE_MS);
    try {
      while (this.#queue.length && !this.#closed) await this.#deliverFirst();
    } catch (refused) {
      if (!this.#closed) this.#on.refused(refused);
      return;
    } finally {
      clearTimeout(timer);
      this.#busy = false;
    }
    if (this.#closed) return;
    if (this.#late) this.#on.saved();
    this.#late = false;
    for (const resolve of this.#drained.splice(0)) resolve();
  }

  async #deliverFirst() {
    const message = this.#queue[0];
    const { key, path } = message;
    const retrying = (attempt, status) => {
      // The first tries, then ever fewer: an outage of a day fills no log.
      if (Number.isInteger(Math.log2(attempt))) this.log("retried", { path, attempt, status });
    };
    const reply = await patiently(path, () => this.#sent(message), retrying);
    if (this.#closed) return;
    this.#queue.shift();
    this.#took[path] = tenths(now() - message.at);
    this.#keep();
    this.#waiting.get(key)?.(reply);
    this.#waiting.delete(key);
  }

  #tellLate() {
    if (this.#closed) return;
    this.#late = true;
    this.#on.late();
  }

  /**
   * A message as it is sent now: it says how long it has waited. One queued before an upgrade
   * cannot, nor one that was queued before the device's clock was set back.
   */
  #sent({ at, after, body }) {
    const [waited, took] = [now() - at, this.#took[after]];
    return {
      ...body,
      ...(waited >= 0 && { waited_ms: tenths(waited) }),
      ...(took >= 0 && { played_took_ms: took }),
    };
  }

  #add(path, body, after = null) {
    const key = uuid();
    const whose = { key, participant: this.#participant };
    const events = this.#events.splice(0, MOST_EVENTS);
    const message = { key, path, after, at: now(), body: { ...whose, ...body, events } };
    this.#queue.push(message);
    this.#keep();
    return message;
  }

  #keep() {
    if (!this.#closed) write(this.#name, { queue: this.#queue, events: this.#events, took: this.#took });
  }
}

function uuid() {
  const bytes = crypto.getRandomValues(new Uint8Array(16)); // randomUUID() needs https
  bytes[6] = (bytes[6] & 0x0f) | 0x40;
  bytes[8] = (bytes[8] & 0x3f) | 0x80;
  const hex = [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
  return hex.replace(/^(.{8})(.{4})(.{4})(.{4})(.{12})$/, "$1-$2-$3-$4-$5");
}
