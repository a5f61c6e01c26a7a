// The bodies of a scene, in the shape of a frame.
import { SoftBody, takesColours } from './soft_body.js';

export class Shapes {
  // `fineness`: share of the triangles that a body may have after refinement.
  constructor(fineness) {
    this.fineness = fineness;
    this.clear();
  }

  clear() {
    this.specs = this.topology = this.built = this.frame = undefined;
    this.bodies = [];
  }

  setScenery(scenery) {
    this.clear();
    this.specs = scenery.bodies;
  }

  // Whether the bodies now have the shape of this frame: it may be older or newer than the topology.
  take(frame) {
    const { topology, specs } = this;
    if (!specs || !topology || !frame || frame.topology !== topology.number) return false;
    if (this.built !== topology) {
      topology.bodies.forEach((triangles, b) => this.setTriangles(b, triangles, topology.pieces[b]));
      this.built = topology;
      this.frame = undefined;
    }
    if (this.frame === frame) return true;
    this.frame = frame;
    this.most = 0;  // the largest displacement of what is coloured by it [m]
    this.bodies.forEach((body, b) => {
      const most = body.place(frame.bodies[b]);
      if (takesColours(body.spec.finish)) this.most = Math.max(this.most, most);
    });
    return true;
  }

  setTriangles(b, triangles, pieces) {
    const body = this.bodies[b], spec = this.specs[b];
    if (!body) this.bodies[b] = new SoftBody(spec, triangles, this.fineness * spec.max_triangles);
    else if (!same(body.refinement.coarseTriangles, triangles)) body.setTriangles(triangles);
    if (pieces) this.bodies[b].visual.part(pieces);
  }
}

function same(a, b) {
  return a.length === b.length && a.every((value, i) => value === b[i]);
}
