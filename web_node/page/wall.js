// As render_node/thick_wall.hpp: both sides of a thin wall and the rims of its openings, from its middle surface.
export class ThickWall {
  constructor(triangles, vertices, thickness) {
    this.half = 0.5 * thickness;
    this.vertices = vertices;
    const inner = [];
    for (let t = 0; t < triangles.length; t += 3) inner.push(triangles[t], triangles[t + 2], triangles[t + 1]);
    this.from = Array.from({ length: vertices }, (_, v) => v);
    this.rims = [];
    this.addRims(triangles, inner);
    this.innerTriangles = Uint32Array.from(inner);
    this.outer = side(vertices);
    this.inner = side(this.from.length);
  }

  addRims(triangles, inner) {
    const next = border(triangles, this.vertices), before = new Map(), place = new Map();
    for (const [a, b] of next) before.set(b, a);
    for (const [a, b] of next) {
      place.set(a, this.vertices + 2 * this.rims.length);
      this.rims.push([a, before.get(a) ?? a, b]);
      this.from.push(a, a);
    }
    for (const [a, b] of next) {
      if (!place.has(b)) continue;
      const oa = place.get(a), ob = place.get(b);
      inner.push(ob, oa, oa + 1, ob, oa + 1, ob + 1);
    }
  }

  place(p, n) {
    const { outer, inner, half } = this;
    for (let i = 0; i < 3 * this.vertices; ++i) {
      outer.position[i] = p[i] + half * n[i];
      outer.normal[i] = n[i];
      inner.position[i] = p[i] - half * n[i];
      inner.normal[i] = -n[i];
    }
    this.rims.forEach(([vertex, before, after], r) => this.placeRim(p, n, 3 * vertex, 3 * before, 3 * after, r));
  }

  placeRim(p, n, v, before, after, rim) {
    const { outer, inner } = this, at = 3 * (this.vertices + 2 * rim);
    const ax = p[after] - p[before], ay = p[after + 1] - p[before + 1], az = p[after + 2] - p[before + 2];
    const o = [ay * n[v + 2] - az * n[v + 1], az * n[v] - ax * n[v + 2], ax * n[v + 1] - ay * n[v]];
    const length = Math.max(Math.hypot(...o), 1e-20);
    for (let i = 0; i < 3; ++i) {
      inner.position[at + i] = outer.position[v + i];
      inner.position[at + 3 + i] = inner.position[v + i];
      inner.normal[at + i] = inner.normal[at + 3 + i] = o[i] / length;
    }
  }
}

function side(vertices) {
  return { position: new Float32Array(3 * vertices), normal: new Float32Array(3 * vertices) };
}

// Edges that one triangle has alone: per start its end, in that triangle's direction.
function border(triangles, vertices) {
  const edges = new Set(), next = new Map();
  const ends = (t, k) => [triangles[t + k], triangles[t + (k + 1) % 3]];
  for (let t = 0; t < triangles.length; t += 3)
    for (let k = 0; k < 3; ++k) {
      const [a, b] = ends(t, k);
      edges.add(a * vertices + b);
    }
  for (let t = 0; t < triangles.length; t += 3)
    for (let k = 0; k < 3; ++k) {
      const [a, b] = ends(t, k);
      if (!edges.has(b * vertices + a)) next.set(a, b);
    }
  return next;
}
