// Watches the game as somebody beside the participant would: which frames came, where the robot
// was drawn, when something was pressed. It runs before the page's scripts and shares nothing with
// them. All times are milliseconds on the time line of frames and events.
(() => {
  let seen;
  const begin = () => {
    seen = { origin: performance.timeOrigin, frames: [], places: [], presses: [], releases: [] };
  };
  begin();
  window.onlooker = { begin, seen: () => seen };

  requestAnimationFrame(function frame(time) {
    seen.frames.push(time);
    requestAnimationFrame(frame);
  });

  // The robot's body is the only path object that is filled on the maze; its middle is the origin.
  // It is kept as rows and columns from the maze's middle. A robot that stands still is squeezed
  // in height as much as it is stretched in width: their mean is the size of a cell.
  const { fill } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.fill = function (...what) {
    if (this.canvas.id === "maze" && what[0] instanceof Path2D) {
      const { a, d, e, f } = this.getTransform();
      const { width, height } = this.canvas;
      const cell = (a + d) / 2;
      const place = [(f - height / 2) / cell, (e - width / 2) / cell];
      seen.places.push([document.timeline.currentTime, ...place]);
    }
    return fill.apply(this, what);
  };

  const hear = (list) => (event) => {
    if (!event.isTrusted) return;
    const [places, frames] = [seen.places.length, seen.frames.length];
    list().push({ at: event.timeStamp, handled: performance.now(), places, frames });
  };
  for (const type of ["pointerdown", "keydown"]) addEventListener(type, hear(() => seen.presses), true);
  for (const type of ["pointerup", "keyup"]) addEventListener(type, hear(() => seen.releases), true);
})();
