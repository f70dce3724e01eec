// The two questions after a stop: which area, and how sure. By pointer, by keyboard, or on the maze.

import { tenths } from "./storage.js";

const PLAIN = (event) => !event.repeat && !event.ctrlKey && !event.metaKey && !event.altKey;

export class Questions {
  #form;
  #player;
  #drive;
  #onAnswer;
  #since = 0;
  #times = {};
  #sent = false;

  /** `onAnswer` gets {guess, confidence, guess_latency_ms, confidence_latency_ms}, once a round. */
  constructor(root, player, onAnswer) {
    this.#form = root.querySelector("#questions");
    this.#drive = root.querySelector("#drive");
    this.#player = player;
    this.#onAnswer = onAnswer;
    this.#form.addEventListener("change", (event) => this.#note(event.target.name, event.timeStamp));
    this.#form.addEventListener("submit", (event) => this.#submit(event));
    // Single letters and digits act only while the questions have the focus (WCAG 2.1.4).
    this.#form.addEventListener("keydown", (event) => this.#key(event));
    player.canvas.addEventListener("click", (event) => this.#pointAt(event));
    player.canvas.addEventListener("pointermove", (event) => {
      const area = this.#form.hidden ? null : player.scene.areaAt(event.clientX, event.clientY);
      player.canvas.classList.toggle("pointing", area !== null);
    });
  }

  get open() {
    return !this.#form.hidden && !this.#sent;
  }

  /** Ask about this animation; latencies count from `since`, the moment of the stop. */
  ask(playback, since) {
    this.#since = since;
    this.#times = {};
    this.#sent = false;
    this.#form.reset();
    this.#form.querySelector("#missing").textContent = "";
    this.#form.querySelector("#areas").replaceChildren(...playback.areas.map(areaChoice));
    this.#drive.hidden = true;
    this.#form.hidden = false;
    this.#form.focus({ preventScroll: true });
    this.#form.scrollIntoView({ block: "nearest" });
  }

  /** Put the questions away; Play is here again. */
  close() {
    this.#form.hidden = true;
    this.#drive.hidden = false;
  }

  #value(name) {
    return this.#form.elements[name]?.value || null;
  }

  #note(name, time) {
    this.#times[name] = time - this.#since;
    this.#form.querySelector("#missing").textContent = "";
    if (name === "guess") this.#player.scene.draw({ chosen: this.#value("guess") });
  }

  #choose(name, value, time) {
    const input = this.#form.querySelector(`input[name="${name}"][value="${value}"]`);
    if (!input) return;
    input.checked = true;
    this.#note(name, time);
    if (name === "confidence") input.focus();
  }

  #key(event) {
    if (!this.open || !PLAIN(event)) return;
    const letters = [...this.#form.querySelectorAll('input[name="guess"]')].map((input) => input.value);
    const key = event.key.toUpperCase();
    if (letters.includes(key)) {
      this.#choose("guess", key, event.timeStamp);
      this.#firstDegree().focus();
    } else if (/^[1-9]$/.test(key)) {
      if (this.#value("guess")) this.#choose("confidence", key, event.timeStamp);
      else if (letters[key - 1]) {
        this.#choose("guess", letters[key - 1], event.timeStamp);
        this.#firstDegree().focus();
      }
    } else if (key === "ENTER" && event.target === this.#form) {
      event.preventDefault();
      this.#form.requestSubmit();
    }
  }

  #firstDegree() {
    return this.#form.querySelector('input[name="confidence"]:checked') ?? this.#form.querySelector('input[name="confidence"]');
  }

  #pointAt(event) {
    if (!this.open) return;
    const area = this.#player.scene.areaAt(event.clientX, event.clientY);
    if (area) this.#choose("guess", area.letter, event.timeStamp);
    this.#form.focus({ preventScroll: true });
  }

  #submit(event) {
    event.preventDefault();
    if (!this.open) return;
    const [guess, confidence] = [this.#value("guess"), this.#value("confidence")];
    if (!guess || !confidence) {
      const [text, name] = guess ? ["Say how sure you are.", "confidence"] : ["Choose an area first.", "guess"];
      this.#form.querySelector("#missing").textContent = text;
      this.#form.querySelector(`input[name="${name}"]`).focus();
      return;
    }
    this.#sent = true;
    this.#onAnswer({
      guess,
      confidence: Number(confidence),
      guess_latency_ms: tenths(Math.max(0, this.#times.guess)),
      confidence_latency_ms: tenths(Math.max(0, this.#times.confidence)),
    }, event.timeStamp);
  }
}

function areaChoice(area) {
  const choice = document.getElementById("area-template").content.cloneNode(true).firstElementChild;
  const input = choice.querySelector("input");
  choice.classList.add(`area-${area.colour}`);
  choice.querySelector("use").setAttribute("href", `#pattern-${area.pattern}`);
  choice.querySelector("text").textContent = area.letter;
  input.value = area.letter;
  input.setAttribute("aria-label", `${area.letter}, ${area.colour} with ${area.pattern}`);
  return choice;
}
