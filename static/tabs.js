// One tab at a time: a newcomer asks whether the study is open already, and may take over.
// Where two claims meet, as when a browser opens two tabs in the same instant, the newer one wins.

const REPLY_MS = 150;

export class Tabs {
  #channel;
  #on;
  #active = false;
  #since = 0; // when this tab claimed last; the fraction tells apart what began in one millisecond
  #answers = () => {};

  /** `on`: {yield(): this tab is inactive from now on, newcomer(): another tab has asked}. */
  constructor(name, on) {
    this.#on = on;
    this.#channel = new BroadcastChannel(name);
    this.#channel.onmessage = ({ data }) => this.#heard(data);
  }

  /** Make this tab the active one, unless another one is, or claims it after this one. */
  async claim() {
    if (await this.#ask("anybody?", ({ what, since }) => what === "here" || since > this.#since)) return false;
    this.#active = true;
    this.#say("mine"); // to a tab that was asleep, or has not heard the question
    return true;
  }

  /** Make this tab the active one; another one has put everything away when this resolves. */
  async take() {
    await this.#ask("mine", ({ what }) => what === "yours");
    this.#active = true;
  }

  #heard({ what, since }) {
    if (what === "anybody?" && this.#active) {
      this.#say("here");
      this.#on.newcomer();
    } else if (what === "mine" && this.#active && since > this.#since) {
      this.#active = false;
      this.#on.yield();
      this.#say("yours");
    } else this.#answers({ what, since });
  }

  #say(what) {
    this.#channel.postMessage({ what, since: this.#since });
  }

  /** Whether an answer came in time; `answers(message)` tells what counts as one. */
  #ask(question, answers) {
    this.#since = Date.now() + Math.random();
    return new Promise((resolve) => {
      const timer = setTimeout(resolve, REPLY_MS, false);
      this.#answers = (message) => {
        if (!answers(message)) return;
        clearTimeout(timer);
        resolve(true);
      };
      this.#say(question);
    });
  }
}
