// Mouse, touch and keys over the picture.
const pinched = 0.1;  // [m] that the tool goes when two fingers come nearer by the picture's height

// The browser's own keys are not the page's, nor are those in a list that chooses by them.
const ownsKeys = (event) => !event.ctrlKey && !event.metaKey && !event.altKey && !event.target.matches?.('select');

export class Input {
  constructor(canvas, app) {
    this.canvas = canvas;
    this.app = app;
    this.touches = new Map();
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    // Before the display's next picture, where the browser tells: on this host, and over TLS.
    canvas.addEventListener('pointerrawupdate', (event) => this.leadTool(event));
    for (const type of ['pointerup', 'pointercancel', 'lostpointercapture'])
      canvas.addEventListener(type, (event) => this.up(event));
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    addEventListener('keydown', (event) => this.key(event, true));
    addEventListener('keyup', (event) => this.key(event, false));
    addEventListener('blur', () => this.app.hand.pedal(false));
  }

  // From -1 to 1, y upwards.
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height];
  }

  down(event) {
    this.canvas.focus({ preventScroll: true, focusVisible: false });
    this.canvas.setPointerCapture(event.pointerId);
    event.preventDefault();
    this.touches.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.touches.size === 2) {
      const moved = this.kind === 'tool' && this.app.mode === 'move';
      if (!moved) this.app.endDrag();
      this.kind = moved ? 'both' : 'two';
      return;
    }
    if (this.touches.size > 2) return;
    if (event.button === 0) this.kind = this.app.beginDrag(this.place(event)) ? 'tool' : 'orbit';
    else this.kind = event.button === 1 || event.shiftKey ? 'pan' : 'orbit';
  }

  move(event) {
    const before = this.touches.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY], height = this.canvas.clientHeight;
    const by = [(now[0] - before[0]) / height, (now[1] - before[1]) / height];
    if (this.kind === 'two') this.pinch(event.pointerId, now, by);
    if (this.kind === 'both') this.grasp(event.pointerId, now);
    this.touches.set(event.pointerId, now);
    this.leadTool(event);
    if (this.kind === 'orbit') this.app.camera.orbit(3.5 * by[0], 3.5 * by[1]);
    if (this.kind === 'pan') this.app.pan(by[0], -by[1]);
  }

  leadTool(event) {
    if (this.kind === 'tool' && this.touches.has(event.pointerId))
      this.app.dragTo(this.place(event), event.timeStamp);
  }

  // Two fingers: apart zooms, together pans and turns.
  pinch(id, now, by) {
    const other = [...this.touches].find(([key]) => key !== id)?.[1];
    if (!other) return;
    const before = this.touches.get(id), span = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
    this.app.camera.zoom(Math.max(span(before), 1) / Math.max(span(now), 1));
    this.app.camera.orbit(1.7 * by[0], 1.7 * by[1]);
  }

  // Two fingers on a tool that is moved: together pushes it away, apart pulls it near, a twist rolls it.
  grasp(id, now) {
    const other = [...this.touches].find(([key]) => key !== id)?.[1];
    if (!other) return;
    const [was, is] = [this.touches.get(id), now].map((p) => [p[0] - other[0], p[1] - other[1]]);
    this.app.deeper(pinched * (Math.hypot(...was) - Math.hypot(...is)) / this.canvas.clientHeight);
    this.app.hand.roll(Math.atan2(was[0] * is[1] - was[1] * is[0], was[0] * is[0] + was[1] * is[1]));
  }

  up(event) {
    if (!this.touches.delete(event.pointerId)) return;
    if (this.kind === 'tool' || this.kind === 'both') this.app.endDrag();
    if (this.kind === 'both') this.kind = undefined;
    if (this.touches.size === 0) this.kind = undefined;
  }

  wheel(event) {
    event.preventDefault();
    const notches = -event.deltaY / (event.deltaMode === 1 ? 3 : 100);
    if (this.kind !== 'tool') this.app.camera.zoom(Math.exp(-0.12 * notches));
    else if (event.shiftKey) this.app.hand.roll(0.1 * (notches || -event.deltaX / 100));
    else this.app.deeper(0.001 * notches);
  }

  // A key that comes up is heard wherever the focus has gone meanwhile, and with whatever else is down.
  key(event, down) {
    const act = this.app.keys[event.key.toLowerCase()], elsewhere = !ownsKeys(event);
    if (!act || (down && (elsewhere || (event.repeat && !act.repeats)))) return;
    if (!elsewhere) event.preventDefault();
    act(down);
  }
}
