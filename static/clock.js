// The clock of one animation: pure, without page or timers. All times are milliseconds on one
// time line (that of animation frames and events); a position is motion time since the first frame.
// Nothing is seen before it is drawn: while the page is frozen, no position is reached beyond one
// usual frame after the last one.

export class Clock {
  #since = null; // when the present stretch of motion began
  #lastFrame = null; // when the last frame in motion was drawn
  #pausedAt;

  /** A clock over `lengthMs` of motion; one that goes on after a reload brings what it had reached. */
  constructor(lengthMs, { positionMs = 0, pauses = 0, pausedMs = 0, pausedAt = null } = {}) {
    this.lengthMs = lengthMs;
    this.reachedMs = clamp(positionMs, 0, lengthMs);
    this.pauses = pauses;
    this.pausedMs = pausedMs;
    this.frameMs = 1000 / 60;
    this.lastFrameMs = this.reachedMs; // the position drawn last
    this.pressMs = null; // the position at the stop by the time line alone, drawn or not
    this.stoppedMs = null;
    this.#pausedAt = pausedAt;
  }

  get running() {
    return this.#since !== null;
  }

  /** Begin, or go on after a pause: `time` is that of the first frame in motion, `frameMs` the usual gap. */
  run(time, frameMs = this.frameMs) {
    if (this.running || this.stoppedMs !== null) return;
    if (this.#pausedAt !== null) this.pausedMs += Math.max(0, time - this.#pausedAt);
    this.#pausedAt = null;
    this.frameMs = frameMs;
    this.#since = this.#lastFrame = time;
  }

  /** A frame is drawn at `time`: the position it shows. */
  frame(time) {
    if (!this.running) return this.position(time);
    this.#lastFrame = Math.max(time, this.#lastFrame);
    this.lastFrameMs = this.#elapsed(this.#lastFrame);
    return this.lastFrameMs;
  }

  /** Hold the motion; time that passes from here on is not counted. */
  pause(time) {
    if (!this.running) return;
    this.reachedMs = this.position(time);
    this.pauses += 1;
    this.#pausedAt = this.#seen(time);
    this.#since = null;
  }

  /** The motion time reached at `time`, within what was reached before, what was drawn and the length. */
  position(time) {
    if (this.stoppedMs !== null) return this.stoppedMs;
    return this.running ? this.#elapsed(this.#seen(time)) : this.reachedMs;
  }

  /** Stop for good at `time`; the first stop counts, whatever comes after it. */
  stop(time) {
    if (this.stoppedMs === null) {
      const position = this.position(time);
      this.pressMs = this.running ? this.#elapsed(time) : position;
      this.#since = null;
      this.stoppedMs = position;
    }
    return this.stoppedMs;
  }

  #seen(time) {
    return Math.min(time, this.#lastFrame + this.frameMs);
  }

  #elapsed(time) {
    return clamp(this.reachedMs + time - this.#since, this.reachedMs, this.lengthMs);
  }

  get reachedEnd() {
    return this.stoppedMs !== null && this.stoppedMs >= this.lengthMs;
  }
}

/** Learns the screen's refresh interval from idle frames and counts the late ones in motion. */
export class FrameMeter {
  #gaps = [];
  #last = null;
  dropped;

  constructor(dropped = 0) {
    this.dropped = dropped;
  }

  /** Note a frame; frames before the motion teach the interval, frames in motion are judged by it. */
  frame(time, inMotion) {
    const gap = this.#last === null ? null : time - this.#last;
    this.#last = time;
    if (gap === null || gap <= 0) return;
    if (!inMotion) this.#gaps.push(gap);
    else if (gap > 1.5 * this.intervalMs) this.dropped += 1;
  }

  /** The frames were interrupted: the next gap means nothing. */
  rest() {
    this.#last = null;
  }

  get intervalMs() {
    if (this.#gaps.length < 5) return 1000 / 60;
    const sorted = [...this.#gaps].sort((a, b) => a - b);
    return sorted[Math.floor(sorted.length / 2)];
  }

  get refreshRateHz() {
    return Math.round(10000 / this.intervalMs) / 10;
  }
}

function clamp(value, low, high) {
  return Math.min(Math.max(value, low), high);
}
