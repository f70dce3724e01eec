// Runs the ten rounds in one page: asks the server where we are, plays, asks, saves, goes on.

import { at, patiently } from "./api.js";
import { Outbox } from "./outbox.js";
import { Player } from "./player.js";
import { Questions } from "./questions.js";
import { read, tenths, write } from "./storage.js";
import { Tabs } from "./tabs.js";

const byId = (id) => document.getElementById(id);
const PARTICIPANT = document.body.dataset.participant;
const OURS = `goalguess:${PARTICIPANT}`;
const WHOSE = `?participant=${PARTICIPANT}`; // the session may be another one's by now
const REACHED = `${OURS}:reached`; // how far the robot of the present round has come
const POINTED = `${OURS}:pointed`; // the last round in which the pointer was moved
const ANSWER_WAITS = "Saving … keep this page open; your answer is safe on this device.";
const OFFLINE = "No connection … trying again.";
const ANOTHER_MAZE = "The first maze had waited too long, so here is another one. Nothing is lost.";

const stage = byId("stage");
let outbox = null; // there is one while this tab is the active one
let trial = null;
let focusLosses = 0;
let pointerMoved = false;

const player = new Player(stage, {
  firstFrame: played,
  step: keepReached,
  pause: keepReached,
  goOn: (time) => outbox.log("continued", { position_ms: player.clock.reachedMs }, time),
  stop: stopped,
});
const questions = new Questions(stage, player, answered);
const tabs = new Tabs(OURS, { yield: giveWay, newcomer: () => outbox.log("second_tab") });

if (await tabs.claim()) start();
else notice("other-tab");

byId("use-tab").addEventListener("click", async () => {
  await tabs.take();
  start();
});
byId("try-again").addEventListener("click", () => {
  notice(null);
  if (trial) outbox.deliver();
  else start();
});

/** Deliver what an earlier visit left behind, then go on where the server says we are. */
async function start() {
  notice(null);
  outbox = new Outbox(`${OURS}:outbox`, PARTICIPANT, {
    late: () => saving(answerWaits() ? ANSWER_WAITS : OFFLINE),
    saved: () => saving("Saved"),
    refused,
  });
  const answerLeft = answerWaits();
  if (answerLeft) saving(ANSWER_WAITS);
  await outbox.flush();
  try {
    show(await patiently(`/api/trial${WHOSE}`, undefined, () => saving(OFFLINE)));
    if (answerLeft) saving("Saved");
    else unsay(OFFLINE);
  } catch (error) {
    if (error.code === "place_returned") await takeAnotherPlace();
    else refused(error);
  }
}

/** Our place went to somebody else before we played. */
async function takeAnotherPlace() {
  try {
    show(await patiently(`/api/place${WHOSE}`, () => ({}), () => saving(OFFLINE)));
    saving(ANOTHER_MAZE);
  } catch (error) {
    refused(error);
  }
}

function show(state) {
  if (!state.trial) return location.assign(at(state.next ?? "/"));
  trial = state.trial;
  byId("round-index").textContent = trial.index;
  byId("progress").value = trial.index - 1;
  outbox.log("shown", { phase: trial.phase, page_opened_ms: Math.round(performance.timeOrigin) });
  const kept = read(REACHED);
  const mine = kept?.index === trial.index ? kept : null;
  focusLosses = mine?.focus_losses ?? 0;
  pointerMoved = read(POINTED) === trial.index;
  if (trial.phase === "asking") {
    player.load(trial.playback, { stoppedMs: trial.stop_time_ms });
    questions.ask(trial.playback, performance.now());
  } else {
    questions.close();
    player.load(trial.playback, trial.phase === "moving" ? reached(mine) : {});
  }
}

/** Where an interrupted round goes on: never before what the server or this browser has noted. */
function reached(mine) {
  return {
    positionMs: Math.max(trial.position_ms, mine?.position_ms ?? 0),
    pauses: (mine?.pauses ?? 0) + (mine?.paused ? 0 : 1),
    pausedMs: mine?.paused_ms ?? 0,
    pausedAt: mine ? mine.at - performance.timeOrigin : performance.now(),
    framesDropped: mine?.frames_dropped ?? 0,
  };
}

function keepReached(time = performance.now()) {
  const { clock, meter } = player;
  write(REACHED, {
    index: trial.index,
    position_ms: clock.position(time),
    paused: !clock.running,
    pauses: clock.pauses,
    paused_ms: clock.pausedMs,
    frames_dropped: meter.dropped,
    focus_losses: focusLosses,
    at: performance.timeOrigin + time,
  });
}

function tell(what, body, after) {
  const path = (moment) => `/api/trials/${trial.index}/${moment}`;
  return outbox.send(path(what), body, after && path(after));
}

function played(time) {
  saving(""); // what was said before the round has been read
  keepReached(time);
  outbox.log("played", {}, time);
  tell("played", {
    ticket: trial.ticket,
    device: {
      viewport_width: innerWidth,
      viewport_height: innerHeight,
      pixel_ratio: devicePixelRatio,
      refresh_rate_hz: player.meter.refreshRateHz,
      pointer_type: player.pointerType,
      reduced_motion: player.reducedMotion,
    },
  });
}

async function stopped(time) {
  const { clock, meter } = player;
  const stop_time_ms = tenths(clock.pressMs); // what of it was seen, the server derives
  const { index } = trial;
  trial.stop_time_ms = stop_time_ms;
  questions.ask(trial.playback, time);
  say("Stopped. Which area is the robot heading for?");
  outbox.log("stopped", { stop_time_ms }, time);
  const reply = await tell("stopped", {
    stop_time_ms,
    last_frame_ms: tenths(clock.lastFrameMs),
    frame_interval_ms: tenths(clock.frameMs),
    reached_end: clock.reachedEnd,
    pauses: clock.pauses,
    paused_ms: tenths(clock.pausedMs),
    focus_losses: focusLosses,
    frames_dropped: meter.dropped,
    reduced_motion: player.reducedMotion,
  }, "played");
  // The server may hold another stop already, made in another tab: that one counts.
  const theirs = reply.repeated ? reply.trial : null;
  const other = theirs && (theirs.index !== index || (theirs.press_ms ?? theirs.stop_time_ms) !== stop_time_ms);
  if (other && trial.index === index && questions.open) show(reply);
}

async function answered(answer, time) {
  byId("next").setAttribute("aria-busy", "true");
  outbox.log("answered", {}, time);
  const { stop_time_ms } = trial;
  const reply = await tell("answered", { ...answer, stop_time_ms, pointer_moved: pointerMoved });
  byId("next").removeAttribute("aria-busy");
  show(reply);
  if (!reply.trial) return;
  byId("play").focus({ preventScroll: true });
  scrollTo({ top: 0 });
  say(`Round ${trial.index} of ${trial.of}`);
}

function refused(error) {
  if (error.code === "wrong_step" || error.code === "place_returned") outbox.drop();
  const elsewhere = ["wrong_step", "place_returned", "moved"].includes(error.code);
  if (elsewhere || error.status === 401) return location.reload();
  player.pause(performance.now());
  saving("");
  if (error.code === "other_participant") {
    outbox.close(); // what waits in it stays, for when its participant is back
    return notice("other-person");
  }
  byId("trouble-detail").textContent = error.message;
  notice("trouble");
}

function giveWay() {
  player.pause(performance.now());
  outbox.close();
  outbox = null;
  trial = null;
  saving("");
  byId("other-tab-title").textContent = "You went on in another tab";
  notice("other-tab");
}

/** Show one of the notices in place of the game, or the game. */
function notice(id) {
  byId("rounds").hidden = id !== null;
  for (const one of ["other-tab", "other-person", "trouble"]) byId(one).hidden = one !== id;
  if (id) byId(id).focus();
}

function answerWaits() {
  return outbox.waiting.some((path) => path.endsWith("/answered"));
}

function saving(text) {
  byId("saving").textContent = text;
  if (text === "Saved") setTimeout(unsay, 2500, text);
}

function unsay(text) {
  if (byId("saving").textContent === text) saving("");
}

function say(text) {
  byId("said").textContent = text;
}

document.addEventListener("visibilitychange", (event) => {
  outbox?.log(document.hidden ? "hidden" : "visible", {}, event.timeStamp);
});
addEventListener("blur", (event) => {
  if (player.phase === "moving") focusLosses += 1;
  outbox?.log("focus_lost", {}, event.timeStamp);
});
addEventListener("focus", (event) => outbox?.log("focus_gained", {}, event.timeStamp));

for (const type of ["pointermove", "pointerdown"]) {
  addEventListener(type, (event) => {
    if (!trial || pointerMoved || !event.isTrusted) return;
    pointerMoved = true;
    write(POINTED, trial.index);
  });
}

let resizing = 0;
addEventListener("resize", () => {
  clearTimeout(resizing);
  resizing = setTimeout(() => outbox?.log("resized", { width: innerWidth, height: innerHeight }), 300);
});

addEventListener("pagehide", (event) => {
  if (!outbox || !trial) return;
  const moving = player.phase === "moving";
  if (moving) {
    keepReached(event.timeStamp);
    outbox.log("interrupted", {}, event.timeStamp);
  }
  const position_ms = player.begun ? tenths(player.clock.position(event.timeStamp)) : null;
  outbox.sendLast("/api/events", { trial_index: trial.index, position_ms });
});
// A page that comes back from the browser's memory has missed what happened since.
addEventListener("pageshow", (event) => event.persisted && location.reload());
