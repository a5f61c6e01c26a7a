// As render_node/scene_block.cpp: what every shader knows of the frame, as std140 words.
import { add, cross, dot, multiply, scale, size, sub, unit } from './vec.js';

const maxTools = 8;
export const blockBytes = 4 * (16 + 6 * 4 + maxTools * 5 * 4);

function projection(halfWidth, halfHeight, near, far) {
  const p = new Float32Array(16);
  p[0] = 1 / halfWidth;
  p[5] = 1 / halfHeight;
  p[10] = (far + near) / (near - far);
  p[14] = 2 * far * near / (near - far);
  p[11] = -1;
  return p;
}

function viewMatrix(eye, right, up, forward) {
  const back = scale(-1, forward);
  return new Float32Array([
    right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1]);
}

// The camera's axes and extent: eye, unit right, up and forward, distance to its target, half the picture at
// distance 1.
export function axesOf(camera, width, height) {
  const toTarget = sub(camera.target, camera.eye), reach = size(toTarget);
  const forward = scale(1 / reach, toTarget);
  const right = unit(cross(forward, camera.up)), up = cross(right, forward);
  const halfHeight = Math.tan(0.5 * camera.field_of_view * Math.PI / 180);
  return { eye: camera.eye, right, up, forward, reach, halfHeight, halfWidth: halfHeight * width / height };
}

export const axis = (pose, column) => [pose[4 * column], pose[4 * column + 1], pose[4 * column + 2]];
export const origin = (pose) => axis(pose, 3);

// The shadow of a shaft is the plane through it and the light; the tip ends it with a disc.
function toolWords(shape, pose, light) {
  const along = axis(pose, 2), ahead = 0.75 * shape.jaw_length;
  const tip = add(origin(pose), scale(ahead, along));
  const tipRadius = shape.jaw_length > 0 ? 1.4 * shape.jaw_radius : shape.tip_radius;
  const shaft = scale(-shape.shaft_length - ahead, along), length2 = dot(shaft, shaft);
  const toTip = sub(tip, light), toEnd = add(toTip, shaft);
  const across = unit(cross(toTip, toEnd));
  const inPlane = unit(sub(toEnd, scale(dot(toEnd, toTip) / dot(toTip, toTip), toTip)));
  const foot = sub(toTip, scale(dot(toTip, shaft) / length2, shaft));
  const near = scale(1 / Math.max(dot(foot, foot), 1e-12), foot);
  return [...tip, tipRadius, ...shaft, shape.shaft_radius, ...across, 1 / length2, ...inPlane, 0, ...near, 0];
}

// `tools`: [{shape, pose}] of those that are seen. `legendMax`: scalar of the last colour.
export function sceneBlock(axes, width, height, tools, legendMax) {
  const { eye, right, up, forward, reach, halfWidth, halfHeight } = axes;
  const words = new Float32Array(blockBytes / 4);
  const view = viewMatrix(eye, right, up, forward);
  words.set(multiply(projection(halfWidth, halfHeight, 0.02 * reach, 20 * reach), view));
  const light = add(eye, scale(reach, add(scale(0.12, up), scale(0.08, right))));
  words.set([...eye, reach, ...scale(halfWidth, right), 2 * halfHeight / height, ...scale(halfHeight, up), legendMax,
    ...forward, 1, ...light, 0, width, height, 2 / height, 1], 16);
  tools.slice(0, maxTools).forEach(({ shape, pose }, i) => words.set(toolWords(shape, pose, light), 40 + 20 * i));
  return words;
}
