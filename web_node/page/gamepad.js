// A gamepad or a 6-axis mouse moves the tool that is held.
import { add, scale } from './vec.js';

const speed = 0.06, turning = 2, dead = 0.12;  // [m/s], [rad/s], of the sticks
const sixAxes = /3dconnexion|space ?(mouse|navigator|pilot|explorer)|256f/i;  // what such a mouse calls itself

const beyond = (x) => (Math.abs(x) < dead ? 0 : (x - Math.sign(x) * dead) / (1 - dead));

// What is wanted, each from -1 to 1: across the view, along it and in roll; pedal and jaws from 0 to 1. `jaws` is
// undefined where there is no button for them.
export function wanted(pad) {
  const button = (i) => pad.buttons[i]?.value;
  if (sixAxes.test(pad.id) && pad.axes.length >= 6) {
    const [right, towards, down, , , turned] = pad.axes.map(beyond);
    return { right, up: -down, ahead: -towards, roll: turned, pedal: button(0) ?? 0, jaws: button(1) };
  }
  if (pad.axes.length < 4) return undefined;
  const [right, down, roll, towards] = pad.axes.map(beyond);
  return { right, up: -down, ahead: -towards, roll, pedal: button(6) ?? 0, jaws: button(7) };
}

// `seconds`: since the last call. `take`: asks for the tool.
export function readGamepad(hand, axes, seconds, take) {
  const pads = [...(navigator.getGamepads?.() ?? [])].filter((pad) => pad?.connected);
  const says = pads.map(wanted).find(Boolean);
  if (!says) return;
  const { right, up, ahead, roll, pedal, jaws } = says;
  const asks = right !== 0 || up !== 0 || ahead !== 0 || roll !== 0 || pedal > 0.5 || jaws > 0.1;
  if (asks && !hand.pose) take();
  if (!hand.pose) return;
  const by = add(add(scale(right, axes.right), scale(up, axes.up)), scale(ahead, axes.forward));
  hand.shift(scale(speed * seconds, by));
  hand.roll(turning * seconds * roll);
  if (jaws !== undefined) hand.pose.grip = 0.6 * (1 - jaws);
  hand.pedal(pedal > 0.5);
}
