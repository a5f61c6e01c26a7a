// A gamepad or a 6-axis mouse moves the tool that is held.
import { add, scale } from './vec.js';

const speed = 0.06, turning = 2, dead = 0.12;  // [m/s], [rad/s], of the sticks
const noticed = 0.02;  // of a button's way: less is no change
const sixAxes = /3dconnexion|space ?(mouse|navigator|pilot|explorer)|256f/i;  // what such a mouse calls itself

const beyond = (x) => (Math.abs(x) < dead ? 0 : (x - Math.sign(x) * dead) / (1 - dead));

// What is wanted, each from -1 to 1: across the view, along it and in roll; pedal and jaws from 0 to 1. `jaws` is
// undefined where there is no button for them.
function wanted(pad, axes) {
  const button = (i) => pad.buttons[i]?.value;
  if (sixAxes.test(pad.id) && axes.length >= 6) {
    const [right, towards, down, , , turned] = axes;
    return { right, up: -down, ahead: -towards, roll: turned, pedal: button(0) ?? 0, jaws: button(1) };
  }
  const [right, down, roll, towards] = axes;
  return { right, up: -down, ahead: -towards, roll, pedal: button(6) ?? 0, jaws: button(7) };
}

// What it says counts from when a person moves something on it: it may be only plugged in.
export class Gamepad {
  // `seconds`: since the last call. `take`: asks for the tool.
  read(hand, axes, seconds, take) {
    const pad = [...(navigator.getGamepads?.() ?? [])].find((one) => one?.connected && one.axes.length >= 4);
    if (pad?.id !== this.id) this.meet(pad);
    if (!pad) return;
    const { right, up, ahead, roll, pedal, jaws } = wanted(pad, pad.axes.map((x, i) => this.moved(i, x)));
    const pedals = this.changes('pedal', pedal > 0.5 ? 1 : 0) && hand.shape.cuts;
    const grips = this.changes('jaws', jaws) && hand.shape.grips;
    const moves = right !== 0 || up !== 0 || ahead !== 0 || roll !== 0;
    if (!hand.pose && (moves || (pedals && pedal > 0.5) || (grips && jaws > 0.1))) take();
    if (!hand.pose) return;
    const by = add(add(scale(right, axes.right), scale(up, axes.up)), scale(ahead, axes.forward));
    hand.shift(scale(speed * seconds, by));
    hand.roll(turning * seconds * roll);
    if (grips) hand.jaws(1 - jaws);
    if (pedals) hand.pedal(pedal > 0.5);
  }

  meet(pad) {
    this.id = pad?.id;
    this.centred = new Set();  // axes that have been at rest: a throttle's may never be
    this.counted = {};  // of each button the value that counted last
  }

  moved(axis, x) {
    if (beyond(x) === 0) this.centred.add(axis);
    return this.centred.has(axis) ? beyond(x) : 0;
  }

  // Whether a button has moved since it counted last.
  changes(button, value) {
    const before = this.counted[button];
    if (Math.abs(value - before) < noticed) return false;
    this.counted[button] = value;
    return before !== undefined;
  }
}
