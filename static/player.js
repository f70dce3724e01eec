// Plays one animation: joins the clock, the scene and the one button that is Play, Stop and Continue.

import { Clock, FrameMeter } from "./clock.js";
import { Scene } from "./scene.js";

const FROZEN_MS = 1500; // a longer gap between frames showed a still picture
const SETTLE_MS = 350; // a double click on what was here before must not hit what is here now
const WORDS = {
  ready: ["Play", "Press Stop as soon as you know where it is heading."],
  counting: ["Get ready", "Eyes on the robot …"],
  moving: ["Stop", "Where is it heading?"],
  paused: ["Continue", "Paused. The robot waits for you."],
};

export class Player {
  phase = "loading";
  pointerType = "mouse";
  reducedMotion = false;
  #root;
  #button;
  #on;
  #playback = null;
  #countFrom = null;
  #step = 0;
  #seen = 0; // time of the last frame
  #held = null; // the keydown of a key that is down
  #request = 0;
  #settling = 0;

  /** `on`: {firstFrame(time), goOn(time), step(), pause(), stop(time)}, each of them optional. */
  constructor(root, on = {}) {
    this.#root = root;
    this.#on = on;
    this.#button = root.querySelector("#play");
    this.canvas = root.querySelector("#maze");
    this.scene = new Scene(this.canvas);
    this.#button.addEventListener("click", (event) => this.#click(event));
    this.#button.addEventListener("pointerdown", (event) => this.#pointerDown(event));
    document.addEventListener("keydown", (event) => this.#keyDown(event));
    document.addEventListener("keyup", () => this.#keyUp());
    document.addEventListener("visibilitychange", (event) => {
      if (document.hidden) this.pause(event.timeStamp);
    });
  }

  /** Show an animation; `reached` is what a clock takes, `stoppedMs` where it was stopped already. */
  load(playback, { stoppedMs = null, framesDropped = 0, ...reached } = {}) {
    cancelAnimationFrame(this.#request);
    this.#playback = playback;
    this.reducedMotion = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.lengthMs = (playback.path.length - 1) * playback.step_ms;
    this.clock = new Clock(this.lengthMs, { positionMs: stoppedMs ?? 0, ...reached });
    this.meter = new FrameMeter(framesDropped);
    const steps = this.clock.reachedMs / playback.step_ms;
    this.#step = Math.floor(steps);
    this.begun = this.clock.reachedMs > 0 || this.clock.pauses > 0;
    this.scene.show(playback, { steps, discrete: this.reducedMotion });
    this.#settle();
    if (stoppedMs === null) this.#enter(this.begun ? "paused" : "ready");
    else this.#enter("stopped");
  }

  /** Hold the animation, as when the tab is hidden; Continue goes on from here. */
  pause(time) {
    if (this.phase !== "moving" && this.phase !== "counting") return;
    cancelAnimationFrame(this.#request);
    this.clock.pause(time);
    this.meter.rest();
    this.scene.draw({ ring: null, steps: this.clock.reachedMs / this.#playback.step_ms });
    this.#enter(this.begun ? "paused" : "ready");
    if (this.begun) this.#on.pause?.();
  }

  #enter(phase) {
    this.phase = phase;
    this.#root.dataset.phase = phase;
    this.#button.disabled = !(phase in WORDS);
    if (phase in WORDS) {
      const [label, prompt] = WORDS[phase];
      this.#root.querySelector("#play-label").textContent = label;
      this.#root.querySelector("#prompt").textContent = prompt;
    }
    this.#button.setAttribute("aria-disabled", String(phase === "counting"));
    this.#describe();
  }

  #settle() {
    this.#root.classList.add("settling");
    clearTimeout(this.#settling);
    this.#settling = setTimeout(() => this.#root.classList.remove("settling"), SETTLE_MS);
  }

  /** Play or Continue. Stop is only reached here through a click that no pointer and no key made. */
  #click(event) {
    const assistive = event.detail === 0 && !this.#held;
    if (this.phase === "moving" && assistive) this.#stop(event.timeStamp);
    else if (this.phase === "ready" || this.phase === "paused") {
      if (event.detail === 0) this.pointerType = "keyboard";
      this.#countIn();
    }
  }

  #pointerDown(event) {
    this.pointerType = event.pointerType || "mouse";
    if (this.phase !== "moving" || event.button !== 0) return;
    event.preventDefault();
    this.#stop(event.timeStamp);
  }

  #keyDown(event) {
    const onButton = event.target === this.#button;
    if (event.repeat) {
      if (onButton) event.preventDefault();
      return;
    }
    this.#held = event;
    const inView = this.#button.offsetParent !== null;
    const free = inView && !event.target.closest?.("a, button, input, select, summary");
    const pressed = (event.key === " " && (onButton || free)) || (event.key === "Enter" && onButton);
    if (!pressed || event.ctrlKey || event.metaKey || event.altKey) return;
    if (this.phase === "moving") {
      event.preventDefault();
      this.#stop(event.timeStamp);
    } else if (!onButton && (this.phase === "ready" || this.phase === "paused")) {
      event.preventDefault();
      this.pointerType = "keyboard";
      this.#countIn();
    }
  }

  /** A click made by a key follows its keyup: the key counts as held until that has passed. */
  #keyUp() {
    const released = this.#held;
    setTimeout(() => {
      if (this.#held === released) this.#held = null;
    });
  }

  #countIn() {
    if (this.#root.classList.contains("settling")) return;
    this.#countFrom = null;
    this.#enter("counting");
    this.#request = requestAnimationFrame(this.#frame);
  }

  #frame = (time) => {
    if (this.phase !== "counting" && this.phase !== "moving") return;
    const seen = this.#seen;
    this.#seen = time;
    if (this.phase === "moving" && time - seen > FROZEN_MS) return this.pause(seen);
    this.meter.frame(time, this.phase === "moving");
    if (this.phase === "counting") {
      this.#countFrom ??= time;
      const [counted, whole] = [time - this.#countFrom, this.#playback.lead_in_ms];
      if (counted >= whole) this.#setOff(time);
      else this.scene.draw({ ring: counted / whole });
    }
    if (this.phase === "moving") {
      const position = this.clock.frame(time);
      if (position >= this.lengthMs) return this.#stop(time);
      this.scene.draw({ ring: null, steps: position / this.#playback.step_ms });
      const step = Math.floor(position / this.#playback.step_ms);
      if (step !== this.#step) {
        this.#step = step;
        this.#on.step?.();
      }
    }
    this.#request = requestAnimationFrame(this.#frame);
  };

  #setOff(time) {
    this.clock.run(time, this.meter.intervalMs);
    this.#enter("moving");
    if (!this.begun) {
      this.begun = true;
      this.#on.firstFrame?.(time);
    } else this.#on.goOn?.(time);
  }

  #stop(time) {
    if (this.phase !== "moving") return;
    cancelAnimationFrame(this.#request);
    const stopMs = this.clock.stop(time);
    this.scene.draw({ ring: null, steps: stopMs / this.#playback.step_ms });
    this.#settle();
    this.#enter("stopped");
    this.#on.stop?.(time);
  }

  /** Says in words what sight gives: where the areas are and where the robot is, never where to. */
  #describe() {
    const { rows, cols, areas, path } = this.#playback;
    const place = ([row, col]) => `row ${row + 1}, column ${col + 1}`;
    const robot = path[Math.floor(this.clock.reachedMs / this.#playback.step_ms)];
    const state = {
      ready: `The robot is at ${place(robot)}.`,
      counting: "The robot is about to move.",
      moving: "The robot is moving.",
      paused: `The robot is paused at ${place(robot)}.`,
      stopped: "The robot has stopped.",
    }[this.phase];
    const where = areas.map((area) => `${area.letter} at ${place(area.cell)}`).join("; ");
    this.canvas.setAttribute("aria-label", `Maze of ${rows} rows and ${cols} columns. ${state} Areas: ${where}.`);
  }
}
