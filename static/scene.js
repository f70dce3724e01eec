// Draws one maze and its robot on a canvas, crisp on any screen; it knows no time, only positions.

import { drawRobot, look } from "./robot.js";

const MARGIN = 0.12; // around the border walls, in cells
const COLOURS = {
  floor: "--floor", grid: "--grid", wall: "--wall", plate: "--plate", plateInk: "--plate-ink",
  pattern: "--pattern", accent: "--accent", robot: "--robot", robotEdge: "--robot-edge",
  robotFace: "--robot-face", robotEye: "--robot-eye",
};

export class Scene {
  #canvas;
  #context;
  #playback = null;
  #ground = document.createElement("canvas");
  #colours = {};
  #areaColours = [];
  #view = { steps: 0, ring: null, chosen: null, discrete: false };

  constructor(canvas) {
    this.#canvas = canvas;
    this.#context = canvas.getContext("2d");
    new ResizeObserver(() => this.#fit()).observe(canvas);
    const schemes = ["(prefers-color-scheme: dark)", "(forced-colors: active)"];
    for (const query of schemes) matchMedia(query).addEventListener("change", () => this.#fit());
  }

  /** Take another maze; `view` is where its robot stands. */
  show(playback, view) {
    this.#playback = playback;
    this.#canvas.style.aspectRatio = `${playback.cols + 2 * MARGIN} / ${playback.rows + 2 * MARGIN}`;
    this.#view = { steps: 0, ring: null, chosen: null, discrete: false, ...view };
    this.#fit();
  }

  /** Draw a change: {steps: position in steps, ring: 0..1 of the lead-in or null, chosen, discrete}. */
  draw(view) {
    Object.assign(this.#view, view);
    this.#paint();
  }

  /** The area under a point of the page, or null. */
  areaAt(clientX, clientY) {
    if (!this.#playback) return null;
    const box = this.#canvas.getBoundingClientRect();
    const cell = box.width / (this.#playback.cols + 2 * MARGIN);
    const col = Math.floor((clientX - box.left) / cell - MARGIN);
    const row = Math.floor((clientY - box.top) / cell - MARGIN);
    return this.#playback.areas.find((area) => area.cell[0] === row && area.cell[1] === col) ?? null;
  }

  #fit() {
    const ratio = window.devicePixelRatio || 1;
    const box = this.#canvas.getBoundingClientRect();
    if (!this.#playback || !box.width) return;
    this.#canvas.width = Math.round(box.width * ratio);
    this.#canvas.height = Math.round(box.height * ratio);
    const style = getComputedStyle(this.#canvas);
    const colour = (name) => style.getPropertyValue(name).trim();
    for (const [name, property] of Object.entries(COLOURS)) this.#colours[name] = colour(property);
    this.#areaColours = this.#playback.areas.map((area) => colour(`--area-${area.colour}`));
    this.#paintGround();
    this.#paint();
  }

  /** One cell in device pixels. */
  get #cell() {
    return this.#canvas.width / (this.#playback.cols + 2 * MARGIN);
  }

  #inCells(context) {
    context.setTransform(this.#cell, 0, 0, this.#cell, MARGIN * this.#cell, MARGIN * this.#cell);
  }

  #paintGround() {
    const { rows, cols, walls, areas } = this.#playback;
    this.#ground.width = this.#canvas.width;
    this.#ground.height = this.#canvas.height;
    const context = this.#ground.getContext("2d");
    this.#inCells(context);
    context.fillStyle = this.#colours.floor;
    context.fillRect(0, 0, cols, rows);
    context.lineWidth = 0.03;
    context.strokeStyle = this.#colours.grid;
    context.beginPath();
    for (let row = 1; row < rows; row += 1) line(context, [0, row, cols, row]);
    for (let col = 1; col < cols; col += 1) line(context, [col, 0, col, rows]);
    context.stroke();
    areas.forEach((area, index) => this.#paintArea(context, area, this.#areaColours[index]));
    context.lineWidth = 0.12;
    context.lineCap = "round";
    context.strokeStyle = this.#colours.wall;
    context.beginPath();
    for (const wall of walls) line(context, wall);
    context.stroke();
  }

  #paintArea(context, area, colour) {
    const [row, col] = area.cell;
    context.save();
    context.translate(col + 0.07, row + 0.07);
    context.scale(0.86 / 40, 0.86 / 40);
    context.beginPath();
    context.roundRect(0, 0, 40, 40, 7);
    context.clip();
    context.fillStyle = colour;
    context.fillRect(0, 0, 40, 40);
    context.fillStyle = this.#colours.pattern;
    const { path, rule } = patternOf(area.pattern);
    context.fill(path, rule);
    context.fillStyle = this.#colours.plate;
    context.beginPath();
    context.arc(20, 20, 12, 0, 2 * Math.PI);
    context.fill();
    context.fillStyle = this.#colours.plateInk;
    context.font = `700 17px ${getComputedStyle(this.#canvas).fontFamily}`;
    context.textAlign = "center";
    context.textBaseline = "alphabetic";
    context.fillText(area.letter, 20, 26);
    context.restore();
  }

  #paint() {
    if (!this.#playback || !this.#canvas.width) return;
    const context = this.#context;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.#canvas.width, this.#canvas.height);
    context.drawImage(this.#ground, 0, 0);
    this.#inCells(context);
    this.#paintChosen(context);
    const place = robotPlace(this.#playback.path, this.#view.steps, this.#view.discrete);
    if (this.#view.ring !== null) this.#paintRing(context, place);
    context.translate(place.col + 0.5, place.row + 0.5);
    const hop = this.#view.ring === null || this.#view.discrete ? 0 : Math.abs(Math.sin(9 * this.#view.ring));
    drawRobot(context, this.#colours, { look: place.look, standing: place.standing, hop });
  }

  /** Closes in on the robot during the lead-in, so that eyes find it; always whole, also at the edge. */
  #paintRing(context, { row, col }) {
    const share = this.#view.discrete ? 1 : this.#view.ring;
    context.strokeStyle = this.#colours.accent;
    context.lineWidth = 0.07;
    context.beginPath();
    const radius = 0.56 + 1.5 * (1 - share) ** 2;
    const room = radius + context.lineWidth / 2 - MARGIN;
    const inside = (middle, cells) => Math.min(Math.max(middle, room), cells - room);
    const [x, y] = [inside(col + 0.5, this.#playback.cols), inside(row + 0.5, this.#playback.rows)];
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.stroke();
  }

  #paintChosen(context) {
    const area = this.#playback.areas.find((one) => one.letter === this.#view.chosen);
    if (!area) return;
    context.strokeStyle = this.#colours.accent;
    context.lineWidth = 0.11;
    context.beginPath();
    context.roundRect(area.cell[1] - 0.02, area.cell[0] - 0.02, 1.04, 1.04, 0.2);
    context.stroke();
  }
}

/** Where the robot is after `steps` (with fraction) of its path, where it looks, and whether it stands. */
export function robotPlace(path, steps, discrete) {
  const last = path.length - 1;
  const step = Math.min(Math.floor(steps), last - 1);
  const share = Math.min(steps - step, 1);
  const [from, to] = [path[step], path[step + 1]];
  const before = facing(path, step - 1);
  const now = facing(path, step);
  const stands = !now[0] && !now[1];
  const moved = discrete ? Number(share >= 0.5) : ease(share);
  return {
    row: from[0] + (to[0] - from[0]) * moved,
    col: from[1] + (to[1] - from[1]) * moved,
    look: discrete ? (moved || stands ? now : before) : look(before, now, share),
    standing: stands && share > 0 && share < 1 ? (discrete ? 0.5 : share) : null,
  };
}

/** The direction of a step as [dx, dy]: none, straight ahead, where it fails and before the first. */
function facing(path, step) {
  if (step < 0) return [0, 0];
  const [from, to] = [path[step], path[step + 1]];
  return [to[1] - from[1], to[0] - from[0]];
}

/** Even motion with a gentle swing: slow at the cells' middles, quicker between them. */
function ease(share) {
  return share - (0.55 / (2 * Math.PI)) * Math.sin(2 * Math.PI * share);
}

function line(context, [x1, y1, x2, y2]) {
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
}

function patternOf(name) {
  const shape = document.getElementById(`pattern-${name}`);
  return {
    path: new Path2D(shape?.getAttribute("d") ?? ""),
    rule: shape?.getAttribute("fill-rule") ?? "nonzero",
  };
}
