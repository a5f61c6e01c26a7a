// A hand on a tool: what mouse, touch, keys and gamepad want becomes poses for web_node.
import * as wire from './wire.js';
import { Press } from './press.js';
import { rayThrough } from './camera.js';
import { origin } from './scene_block.js';
import { add, dot, scale, sub } from './vec.js';

const open = 0.6, shut = 0.1;  // [rad] between jaws
const settle = 1000, apart = 8, longest = 1000;  // [ms]; longest: that the server says a sample again

const tipOf = (state) => origin(state.parts[0]);
const standing = (state) => ({ tip: tipOf(state), roll: state.roll, grip: state.grip, pedal: 0 });

// Whether a tool's jaws are.
export const areShut = (state) => state.holding || state.grip < shut;

export class Hand {
  // `bodies()`: as they are now. `shape`: the tool's, as the scenery has it, once that has come.
  constructor(link, bodies) {
    this.link = link;
    this.bodies = bodies;
    this.tool = 0;
    this.number = 0;
    this.depth = 0.01;
    this.pending = [];
    this.delays = [];
    this.lateAt = -Infinity;  // when samples came too late, the last time [ms]
    this.led = 0;  // time [ms] of the event that led the tool on last
    this.rest();
  }

  rest() {
    this.drag = this.wanted = undefined;
    this.pose = undefined;  // {tip, roll, grip, pedal} that is told
    this.told = undefined;  // when it was [ms]
  }

  // A page that is hidden lets go at once, and tells its hand again when it is seen.
  pause() {
    this.pedal(false);
    if (document.hidden) this.link.send(wire.rest());
    this.changed = performance.now();
    this.told = undefined;
  }

  holds(frame, me) {
    return frame?.tools[this.tool]?.holder === me;
  }

  // Let go though it is held: this page's samples came too late.
  watch(frame, me) {
    const state = frame.tools[this.tool], now = performance.now();
    const letGo = this.holds(frame, me) && state.sample > 0 && (state.flags & wire.SILENT) !== 0;
    if (letGo && now - (this.changed ?? 0) > settle) this.lateAt = now;
  }

  // Where the tool is now becomes what is wanted.
  take(frame) {
    const state = frame.tools[this.tool];
    if (!state?.offered || !state.seen) return false;
    this.link.send(wire.take(this.tool));
    this.changed = performance.now();
    this.pose ??= standing(state);
    return true;
  }

  release() {
    if (this.pose) this.link.send(wire.release(this.tool));
    this.changed = performance.now();
    this.rest();
  }

  // What was handed over is held where it is; what another holds is not told of. Frames come late after a change.
  agree(frame, me) {
    if (performance.now() - (this.changed ?? 0) < settle) return;
    const mine = this.holds(frame, me);
    if (mine) this.pose ??= standing(frame.tools[this.tool]);
    else if (!this.drag) this.rest();
  }

  beginPress(frame, axes, at) {
    const press = new Press(this.shape, this.bodies, rayThrough(axes, ...at));
    if (!press.hit || !this.take(frame)) return false;
    this.drag = press;
    return true;
  }

  beginMove(frame, axes, at) {
    if (!this.take(frame)) return false;
    this.drag = { kind: 'move', at, tip: this.pose.tip, along: 0 };
    return true;
  }

  // `event` [ms]: when it happened, so that the picture that shows it can be told. A mouse may move a thousand times a
  // second; what comes too soon after the last waits for the next or for `follow`.
  dragTo(frame, axes, at, event) {
    if (!this.drag || !frame || event <= this.led) return;
    this.wanted = { axes, at, event };
    if (event - this.led >= apart) this.go(frame);
  }

  go(frame) {
    const { drag, wanted: { axes, at, event } } = this;
    this.wanted = undefined;
    this.led = event;
    if (drag.kind === 'press') drag.lead(rayThrough(axes, ...at));
    else this.moveTo(axes, at);
    this.aim(frame);
    this.tell();
    this.pending.push({ number: this.number, event });
  }

  // On the plane through the tip that faces the camera.
  moveTo(axes, at) {
    const { drag } = this, far = dot(sub(drag.tip, axes.eye), axes.forward);
    const right = scale((at[0] - drag.at[0]) * axes.halfWidth * far, axes.right);
    const up = scale((at[1] - drag.at[1]) * axes.halfHeight * far, axes.up);
    this.pose.tip = add(add(add(drag.tip, right), up), scale(drag.along, axes.forward));
    drag.last = at;
  }

  // [m] away from the camera.
  deeper(by, axes) {
    const { drag } = this;
    if (drag?.kind === 'move') {
      drag.along += by;
      this.moveTo(axes, drag.last ?? drag.at);
    } else if (this.pose) this.shift(scale(by, axes.forward));
  }

  shift(by) {
    if (this.pose) this.pose.tip = add(this.pose.tip, by);
  }

  roll(by) {
    if (this.pose) this.pose.roll = Math.min(Math.max(this.pose.roll + by, -3), 3);
  }

  // From 0, shut, to 1, open.
  jaws(opened) {
    if (this.pose) this.pose.grip = open * opened;
  }

  pedal(down) {
    if (this.pose) this.pose.pedal = down ? 1 : 0;
  }

  endDrag(frame) {
    const { drag } = this;
    if (drag?.kind === 'press') this.pose.tip = drag.off(tipOf(frame.tools[this.tool]));
    this.drag = this.wanted = undefined;
  }

  aim(frame) {
    const { drag } = this;
    if (drag?.kind === 'press') this.pose.tip = drag.next(tipOf(frame.tools[this.tool]), this.depth);
  }

  // Sixty times a second.
  follow(frame) {
    if (!this.pose || !frame) return;
    if (this.wanted) return this.go(frame);
    this.aim(frame);
    this.tell();
  }

  tell() {
    if (!this.pose) return;
    const now = performance.now();
    if (now - this.told > longest) this.lateAt = now;
    this.told = now;
    this.number += wire.numbersApart;
    this.link.send(wire.sample(this.tool, this.number, this.pose));
  }

  // The picture that has just been drawn shows this frame.
  drawn(frame, me) {
    const shown = this.holds(frame, me) ? frame.tools[this.tool].sample : 0;
    const now = performance.now();
    while (this.pending.length && this.pending[0].number <= shown)
      this.delays.push(now - this.pending.shift().event);
    if (this.pending.length > 200) this.pending.shift();
    if (this.delays.length > 4000) this.delays.splice(0, 2000);
  }
}
