// One tab at a time: a newcomer asks whether the study is open already, and may take over.

const REPLY_MS = 150;

export class Tabs {
  #channel;
  #on;
  #active = false;
  #hear = null;

  /** `on`: {yield(): this tab is inactive from now on, newcomer(): another tab has asked}. */
  constructor(name, on) {
    this.#on = on;
    this.#channel = new BroadcastChannel(name);
    this.#channel.onmessage = ({ data }) => this.#heard(data);
  }

  /** Make this tab the active one, unless another one is. */
  async claim() {
    if (await this.#ask("anybody?", "here")) return false;
    this.#active = true;
    this.#channel.postMessage("mine"); // to a tab that was asleep and wakes up later
    return true;
  }

  /** Make this tab the active one; another one has put everything away when this resolves. */
  async take() {
    await this.#ask("mine", "yours");
    this.#active = true;
  }

  #heard(data) {
    if (data === "anybody?" && this.#active) {
      this.#channel.postMessage("here");
      this.#on.newcomer();
    } else if (data === "mine" && this.#active) {
      this.#active = false;
      this.#on.yield();
      this.#channel.postMessage("yours");
    } else this.#hear?.(data);
  }

  #ask(question, answer) {
    return new Promise((resolve) => {
      const timer = setTimeout(resolve, REPLY_MS, false);
      this.#hear = (data) => {
        if (data !== answer) return;
        clearTimeout(timer);
        resolve(true);
      };
      this.#channel.postMessage(question);
    });
  }
}
