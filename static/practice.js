// The practice: one animation and its questions as in the real rounds, nothing recorded; then the
// question about the rules.

import { patiently } from "./api.js";
import { Player } from "./player.js";
import { Questions } from "./questions.js";

const byId = (id) => document.getElementById(id);
let playback = null;

const player = new Player(byId("stage"), { stop: (time) => questions.ask(playback, time) });
const questions = new Questions(byId("stage"), player, () => turnTo("control"));

byId("again").addEventListener("click", () => turnTo("practice"));
if (!byId("practice").hidden) begin();

async function begin() {
  try {
    playback ??= await patiently("/api/practice");
  } catch {
    return location.reload(); // no longer at the practice: the server leads to the page that is due
  }
  questions.close();
  player.load(playback);
}

async function turnTo(part) {
  for (const id of ["practice", "control"]) byId(id).hidden = id !== part;
  scrollTo({ top: 0 });
  if (part === "practice") {
    await begin(); // until then the button is disabled and takes no focus
    byId("play").focus({ preventScroll: true });
  } else byId("control").querySelector("h1").focus({ preventScroll: true });
}
