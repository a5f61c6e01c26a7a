// A press of a tool on an organ: out of the tissue that the tool is in, over to above the place, down, and off again.
import { fromLine, pick, snapshot } from './pick.js';
import { add, cross, dot, scale, size, sub, unit } from './vec.js';

const hover = 0.012, near = 0.002;  // [m] above the surface; that a tip may be off its place
const pivotPoint = [0, 0, 0];

export class Press {
  kind = 'press';
  down = false;

  // `shape`: the tool's. `bodies()`: as they are now.
  constructor(shape, bodies, ray) {
    this.shape = shape;
    this.bodies = bodies;
    this.end = shape.jaw_length > 0 ? shape.jaw_radius : shape.tip_radius;
    this.look(ray);
  }

  // The surfaces are those of now. They stay so: one that gives way must not lead the tool on.
  look(ray) {
    this.surfaces = snapshot(this.bodies());
    this.lead(ray);
  }

  lead(ray) {
    this.ray = ray;
    this.hit = pick(this.surfaces, ray) ?? this.hit;
  }

  // Where the tip goes next. Where it is above its place, tissue that it was in has come back.
  next(tip, depth) {
    if (!this.down && this.isAbove(tip)) {
      this.look(this.ray);
      this.down = this.isAbove(tip);
    }
    return this.down ? this.above(-depth) : this.over(tip);
  }

  // Where the tip goes when the press ends: out the way it came, or along its shaft where it has none behind it.
  off(tip) {
    if (this.down && fromLine(tip, this.above(hover), this.hit.normal) < hover) return this.above(hover);
    const { pivot } = this.shape, out = sub(tip, pivot), along = unit(out);
    return add(pivot, scale(Math.min(this.free(along, along), size(out)), along));
  }

  // Tip's place so that what meets tissue first is `height` [m] above the place on the organ.
  above(height) {
    const { point, normal } = this.hit, { jaw_length: jaw, pivot } = this.shape;
    const at = add(point, scale(this.end + height, normal));
    return sub(at, scale(jaw, unit(sub(at, pivot))));
  }

  isAbove(tip) {
    const ready = this.above(hover), { normal } = this.hit;
    return fromLine(tip, ready, normal) < near && dot(sub(tip, ready), normal) > -near;
  }

  // On the way to above the place, each next place in a straight line through nothing: back along the shaft until all
  // between is free, over, and on along the shaft.
  over(tip) {
    const { pivot } = this.shape, ready = this.above(hover), far = size(sub(ready, pivot));
    const to = unit(sub(ready, pivot)), from = unit(sub(tip, pivot));
    if (fromLine(tip, pivot, to) < near) return ready;
    const free = this.free(from, to);
    if (size(sub(tip, pivot)) > free + near) return add(pivot, scale(free, from));
    return add(pivot, scale(Math.min(free, far), to));
  }

  // How far [m] from its pivot the tip may be as the shaft turns from one direction to another and meets nothing.
  free(from, to) {
    const { pivot, jaw_length: jaw } = this.shape, room = this.end + hover;
    const side = unit(cross(from, to)), across = cross(side, from), whole = Math.atan2(dot(to, across), dot(to, from));
    let nearest = Infinity;
    const meet = (point) => {
      const p = sub(point, pivot);
      if (Math.abs(dot(p, side)) > room) return;
      const angle = Math.min(Math.max(Math.atan2(dot(p, across), dot(p, from)), 0), whole);
      const along = add(scale(Math.cos(angle), from), scale(Math.sin(angle), across)), far = dot(p, along);
      if (far > 0 && far < nearest && fromLine(p, pivotPoint, along) < room) nearest = far;
    };
    for (const { position, atRest = [] } of this.surfaces)
      for (const points of [position, atRest])
        for (let i = 0; i < points.length; i += 3) meet([points[i], points[i + 1], points[i + 2]]);
    return Math.max(nearest - room - jaw, room);
  }
}
