// Draws the robot: a body with a face that looks where it goes. It stands at the origin, a cell is 1.

const TURN = 0.16; // share of a step in which the face turns

/** Where the face looks, as [dx, dy]: it turns at the beginning of a step, never before. */
export function look(before, now, share) {
  const turned = Math.min(1, share / TURN);
  const eased = turned * turned * (3 - 2 * turned);
  return [before[0] + (now[0] - before[0]) * eased, before[1] + (now[1] - before[1]) * eased];
}

/** `pose`: {look: [dx, dy], standing: share of a failed step or null, hop: 0..1}. */
export function drawRobot(context, colours, pose) {
  const [dx, dy] = pose.look;
  const still = pose.standing !== null;
  const breath = still ? Math.sin(Math.PI * pose.standing) : 0;

  context.save();
  context.translate(0, -0.05 * pose.hop);
  context.scale(1 + 0.07 * breath, 1 - 0.07 * breath);

  const body = bodyOf(dx, dy);
  context.fillStyle = colours.robot;
  context.strokeStyle = colours.robotEdge;
  context.lineWidth = 0.06;
  context.stroke(body);
  context.fill(body);
  drawFace(context, colours, dx, dy, breath > 0.25);
  context.restore();
  if (still) drawStrokes(context, colours, pose.standing);
}

/** A round box, drawn out to a point in the direction it looks. */
function bodyOf(dx, dy) {
  const body = new Path2D();
  body.roundRect(-0.31, -0.31, 0.62, 0.62, 0.22);
  if (Math.hypot(dx, dy) > 0.5) {
    const nose = new Path2D("M.22-.2C.33-.13.43-.06.43 0S.33.13.22.2z");
    body.addPath(nose, new DOMMatrix().rotate((180 / Math.PI) * Math.atan2(dy, dx)));
  }
  return body;
}

function drawFace(context, colours, dx, dy, blinking) {
  const x = 0.1 * dx;
  const y = 0.1 * dy;
  context.fillStyle = colours.robotFace;
  context.beginPath();
  context.roundRect(x - 0.21, y - 0.135, 0.42, 0.27, 0.13);
  context.fill();
  context.fillStyle = colours.robotEye;
  for (const side of [-1, 1]) {
    context.beginPath();
    const eye = [x + side * 0.095 + 0.035 * dx, y + 0.035 * dy];
    if (blinking) context.roundRect(eye[0] - 0.055, eye[1] - 0.015, 0.11, 0.035, 0.015);
    else context.ellipse(eye[0], eye[1], 0.05, 0.066, 0, 0, 2 * Math.PI);
    context.fill();
  }
}

/** Three strokes above the head, alike on both sides: it stands, and nothing tells where it wanted. */
function drawStrokes(context, colours, share) {
  const strokes = new Path2D("M0-.4V-.56M-.17-.39-.26-.52M.17-.39.26-.52");
  context.save();
  context.globalAlpha = Math.min(1, 8 * share, 8 * (1 - share));
  context.lineCap = "round";
  for (const [colour, width] of [[colours.robotEdge, 0.15], [colours.accent, 0.075]]) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.stroke(strokes);
  }
  context.restore();
}
