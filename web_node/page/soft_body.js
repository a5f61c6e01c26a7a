// A body: coarse positions from the wire become what is drawn.
import { depthsIn } from './marked.js';
import { Refinement, vertexNormals } from './refine.js';
import { VisualShape } from './visual_shape.js';
import { ThickWall } from './wall.js';
import { unpack } from './wire.js';

// Whether the colours of displacement are shown on it.
export const takesColours = (finish) => finish !== 'plastic';

export class SoftBody {
  // `mostTriangles`: after refinement.
  constructor(spec, triangles, mostTriangles) {
    this.spec = spec;
    this.mostTriangles = mostTriangles;
    this.shape = 0;
    if (spec.visual) this.visual = new VisualShape(spec.visual, spec.rest, spec.marked);
    this.setTriangles(triangles);
  }

  setTriangles(triangles) {
    const { spec } = this, coarse = spec.rest.length;
    this.refinement = new Refinement(triangles, spec.rest, this.mostTriangles);
    const floats = () => new Float32Array(3 * this.refinement.vertices);
    this.rest = floats();
    this.rest.set(spec.rest);
    this.position = floats();
    this.position.set(spec.rest);
    this.normal = floats();
    this.displacement = new Float32Array(this.refinement.vertices);
    const restNormal = floats();
    vertexNormals(spec.rest, triangles, restNormal.subarray(0, coarse));
    this.refinement.apply(this.rest, restNormal);
    this.normal.set(restNormal);
    this.position.set(this.rest);
    if (spec.marked) this.marked = depthsIn(spec.marked, this.rest);
    this.texture = this.rest;
    if (spec.texture) {
      this.texture = floats();
      this.texture.set(spec.texture);
      this.refinement.average(this.texture);
    }
    if (spec.finish === 'duct') this.addWall();
    ++this.shape;
  }

  addWall() {
    this.wall = new ThickWall(this.refinement.triangles, this.refinement.vertices, this.spec.thickness);
    this.wall.place(this.position, this.normal);
    this.innerTexture = new Float32Array(3 * this.wall.from.length);
    this.wall.from.forEach((v, i) => this.innerTexture.set(this.texture.subarray(3 * v, 3 * v + 3), 3 * i));
    this.innerDisplacement = new Float32Array(this.wall.from.length);
  }

  // Positions of a frame. The largest displacement [m].
  place(packed) {
    const coarse = this.spec.rest.length, { position, normal, rest } = this;
    if (packed.words.length !== coarse) return 0;
    unpack(packed, position);
    vertexNormals(position, this.refinement.coarseTriangles, normal.subarray(0, coarse));
    this.refinement.apply(position, normal);
    this.wall?.place(position, normal);
    let most = this.visual?.place(position) ?? 0;
    for (let v = 0; v < this.displacement.length; ++v) {
      const i = 3 * v;
      const d = Math.hypot(position[i] - rest[i], position[i + 1] - rest[i + 1], position[i + 2] - rest[i + 2]);
      this.displacement[v] = d;
      if (d > most) most = d;
    }
    this.wall?.from.forEach((v, i) => { this.innerDisplacement[i] = this.displacement[v]; });
    return most;
  }

  // What a ray can meet: {position, normal, triangles}, and the body's own places at rest.
  surfaces() {
    const { position, normal, rest: atRest, refinement: { triangles } } = this;
    const own = { position, normal, atRest, triangles };
    return this.visual ? [own, ...this.visual.views()] : [own];
  }

  // What there is to draw. Where there is a visual surface, the triangles are what cuts have bared.
  views(mucosaColour) {
    const { spec, wall } = this;
    const own = {
      finish: spec.finish, colour: spec.colour, shape: this.shape, position: this.position, normal: this.normal,
      rest: this.texture, scalar: this.displacement, marked: this.marked, triangles: this.refinement.triangles,
    };
    if (this.visual) return [own, ...this.visual.views()];
    if (!wall) return [own];
    return [{ ...own, ...wall.outer },
      { ...own, ...wall.inner, finish: 'mucosa', colour: mucosaColour, rest: this.innerTexture,
        scalar: this.innerDisplacement, triangles: wall.innerTriangles }];
  }
}
