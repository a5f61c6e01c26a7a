// The scene's endoscope, or a camera that turns about its target.
import { add, cross, dot, scale, size, sub, turn, unit } from './vec.js';

export class ViewCamera {
  setScene(camera) {
    this.scene = camera;
    this.endoscope();
  }

  endoscope() {
    this.now = structuredClone(this.scene);
    this.free = false;
  }

  // Angles [rad] about the picture's up axis and its right axis.
  orbit(sideways, upwards) {
    const { now } = this, back = sub(now.eye, now.target), up = unit(now.up);
    const right = unit(cross(scale(-1, back), up));
    let turned = turn(back, up, -sideways);
    const tilted = turn(turned, turn(right, up, -sideways), -upwards);
    if (Math.abs(dot(unit(tilted), up)) < 0.98) turned = tilted;
    now.eye = add(now.target, turned);
    this.free = true;
  }

  // By shares of the picture's height, half of which is `halfHeight` at distance 1.
  pan(right, up, halfHeight) {
    const { now } = this, forward = sub(now.target, now.eye);
    const x = unit(cross(forward, now.up)), y = unit(cross(x, forward));
    const extent = 2 * size(forward) * halfHeight;
    const by = add(scale(-extent * right, x), scale(-extent * up, y));
    now.eye = add(now.eye, by);
    now.target = add(now.target, by);
    this.free = true;
  }

  zoom(factor) {
    const { now, scene } = this, back = sub(now.eye, now.target), far = size(sub(scene.eye, scene.target));
    const wanted = Math.min(Math.max(factor * size(back), 0.1 * far), 4 * far);
    now.eye = add(now.target, scale(wanted / size(back), back));
    this.free = true;
  }

  // In a picture that is narrower than the scene's all that the scene's has of width stays.
  fitted(width, height) {
    const narrow = Math.min(1, width / height / this.now.aspect);
    const half = Math.tan(0.5 * this.now.field_of_view * Math.PI / 180) / narrow;
    return { ...this.now, field_of_view: 2 * Math.atan(half) * 180 / Math.PI };
  }
}

// The ray through a point of the picture, x and y from -1 to 1, y upwards.
export function rayThrough(axes, x, y) {
  const d = add(axes.forward, add(scale(x * axes.halfWidth, axes.right), scale(y * axes.halfHeight, axes.up)));
  return { from: axes.eye, along: unit(d) };
}
