// A gamepad moves the tool that is held: left stick across the view, right stick depth and roll, triggers jaws and
// pedal.
import { add, scale } from './vec.js';

const speed = 0.06, turning = 2, dead = 0.12;  // [m/s], [rad/s], of the sticks

const beyond = (x) => (Math.abs(x) < dead ? 0 : (x - Math.sign(x) * dead) / (1 - dead));

// `seconds`: since the last call. True where it asks for something.
export function readGamepad(hand, axes, seconds, take) {
  const pad = [...(navigator.getGamepads?.() ?? [])].find((one) => one?.connected);
  if (!pad || pad.axes.length < 4) return false;
  const [x, y, roll, depth] = pad.axes.slice(0, 4).map(beyond);
  const [pedal, jaws] = [pad.buttons[6]?.value ?? 0, pad.buttons[7]?.value ?? 0];
  const asks = x !== 0 || y !== 0 || roll !== 0 || depth !== 0 || pedal > 0.5 || jaws > 0.1;
  if (asks && !hand.pose) take();
  if (!hand.pose) return asks;
  const by = add(add(scale(x, axes.right), scale(-y, axes.up)), scale(-depth, axes.forward));
  hand.shift(scale(speed * seconds, by));
  hand.roll(turning * seconds * roll);
  if (pad.buttons[7]) hand.pose.grip = 0.6 * (1 - jaws);
  hand.pedal(pedal > 0.5);
  return asks;
}
