import { depthsIn } from './marked.js';

// As common/mesh/visual_shape.hpp: a visual surface that follows the nodes of its body. Matrices are nine numbers by
// columns.
const leastVolume = 0.05;

export class VisualShape {
  // `spec`: of the scenery; `rest` [m]: of the body's nodes; `marked`: the box of what is to be cut off, if there is one.
  constructor(spec, rest, marked) {
    this.spec = spec;
    if (marked) this.marked = depthsIn(marked, spec.position);
    this.rest = rest;
    this.cells = spec.cells.length / 4;
    this.alive = new Uint8Array(this.cells).fill(1);
    this.inverse = new Float32Array(9 * this.cells);
    this.weight = new Float32Array(this.cells);
    this.moved = Float32Array.from(rest);
    for (let c = 0; c < this.cells; ++c) this.addCell(c);
    this.addTies();
    this.position = Float32Array.from(spec.position);
    this.normal = new Float32Array(this.position.length);
    this.displacement = new Float32Array(this.position.length / 3);
    this.nodeNormal = new Float32Array(3 * spec.nodes);
    this.deformation = new Float32Array(3 * rest.length);
    this.around = new Float32Array(rest.length / 3);
    this.triangles = spec.parts.map((part) => part.triangles);
    this.shape = 1;
    this.frame = new Frame(spec, rest);
    this.findNormals();
  }

  // Edges of a cell as columns; of a triangle the third is its unit normal.
  edges(c, at, e) {
    const { cells } = this.spec, [a, b, d, f] = [0, 1, 2, 3].map((k) => 3 * cells[4 * c + k]);
    for (let i = 0; i < 3; ++i) {
      e[i] = at[b + i] - at[a + i];
      e[3 + i] = at[d + i] - at[a + i];
      if (f >= 0) e[6 + i] = at[f + i] - at[a + i];
    }
    if (f >= 0) return e;
    e[6] = e[1] * e[5] - e[2] * e[4];
    e[7] = e[2] * e[3] - e[0] * e[5];
    e[8] = e[0] * e[4] - e[1] * e[3];
    const by = 1 / Math.max(Math.hypot(e[6], e[7], e[8]), 1e-30);
    for (let i = 6; i < 9; ++i) e[i] *= by;
    return e;
  }

  addCell(c) {
    const e = this.edges(c, this.rest, new Float64Array(9)), size = Math.abs(determinant(e));
    this.inverse.set(invert(e), 9 * c);
    this.weight[c] = this.spec.cells[4 * c + 3] < 0 ? size ** 1.5 : size;
  }

  addTies() {
    const { cell, cells, weight, position } = this.spec, vertices = cell.length, { rest } = this;
    this.node = new Uint32Array(4 * vertices);
    this.arm = new Float32Array(12 * vertices);
    for (let v = 0; v < vertices; ++v) {
      const point = [0, 0, 0];
      for (let k = 0; k < 4; ++k) {
        const n = cells[4 * cell[v] + k];
        this.node[4 * v + k] = n < 0 ? cells[4 * cell[v]] : n;
        for (let i = 0; i < 3; ++i) point[i] += weight[4 * v + k] * rest[3 * this.node[4 * v + k] + i];
      }
      for (let k = 0; k < 4; ++k)
        for (let i = 0; i < 3; ++i) {
          const along = 0.5 * (point[i] - rest[3 * this.node[4 * v + k] + i]);
          this.arm[12 * v + 3 * k + i] = weight[4 * v + k] * (along + position[3 * v + i] - point[i]);
        }
    }
  }

  findDeformation() {
    const { deformation, around, inverse, weight } = this, { cells } = this.spec, e = new Float32Array(9);
    deformation.fill(0);
    around.fill(0);
    for (let c = 0; c < this.cells; ++c) {
      if (!this.alive[c]) continue;
      this.edges(c, this.moved, e);
      const to = 9 * c;
      for (let column = 0; column < 3; ++column)
        for (let row = 0; row < 3; ++row) {
          const i = to + 3 * column;
          const value = weight[c] * (e[row] * inverse[i] + e[3 + row] * inverse[i + 1] + e[6 + row] * inverse[i + 2]);
          for (let k = 0; k < 4 && cells[4 * c + k] >= 0; ++k)
            deformation[9 * cells[4 * c + k] + 3 * column + row] += value;
        }
      for (let k = 0; k < 4 && cells[4 * c + k] >= 0; ++k) around[cells[4 * c + k]] += weight[c];
    }
    for (let n = 0; n < around.length; ++n)
      if (around[n] > 0) for (let i = 9 * n; i < 9 * n + 9; ++i) deformation[i] /= around[n];
  }

  // Follows the nodes [m]. The largest displacement [m].
  place(nodes) {
    const { frame, moved, node, arm, deformation, position } = this, { weight } = this.spec;
    frame.follow(nodes);
    for (let n = 0; n < this.rest.length; n += 3) frame.fromWorld(nodes, n, moved);
    this.findDeformation();
    for (let v = 0; v < node.length / 4; ++v) {
      let x = 0, y = 0, z = 0;
      for (let k = 4 * v; k < 4 * v + 4; ++k) {
        const w = weight[k], n = 3 * node[k], d = 9 * node[k], a = arm[3 * k], b = arm[3 * k + 1], c = arm[3 * k + 2];
        x += w * moved[n] + deformation[d] * a + deformation[d + 3] * b + deformation[d + 6] * c;
        y += w * moved[n + 1] + deformation[d + 1] * a + deformation[d + 4] * b + deformation[d + 7] * c;
        z += w * moved[n + 2] + deformation[d + 2] * a + deformation[d + 5] * b + deformation[d + 8] * c;
      }
      frame.toWorld(x, y, z, position, 3 * v);
    }
    this.findNormals();
    return this.measure();
  }

  measure() {
    const { position, displacement } = this, { position: rest } = this.spec;
    let most = 0;
    for (let v = 0, i = 0; v < displacement.length; ++v, i += 3) {
      const d = Math.hypot(position[i] - rest[i], position[i + 1] - rest[i + 1], position[i + 2] - rest[i + 2]);
      displacement[v] = d;
      if (d > most) most = d;
    }
    return most;
  }

  findNormals() {
    const { position: p, normal, nodeNormal: sum, spec } = this;
    sum.fill(0);
    this.triangles.forEach((triangles, part) => {
      const { first } = spec.parts[part];
      for (let t = 0; t < triangles.length; t += 3) {
        const va = first + triangles[t], vb = first + triangles[t + 1], vc = first + triangles[t + 2];
        const a = 3 * va, b = 3 * vb, c = 3 * vc;
        const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
        const wx = p[c] - p[a], wy = p[c + 1] - p[a + 1], wz = p[c + 2] - p[a + 2];
        const nx = uy * wz - uz * wy, ny = uz * wx - ux * wz, nz = ux * wy - uy * wx;
        for (let k = 0; k < 3; ++k) {
          const n = 3 * spec.node[k === 0 ? va : k === 1 ? vb : vc];
          sum[n] += nx;
          sum[n + 1] += ny;
          sum[n + 2] += nz;
        }
      }
    });
    for (let v = 0; v < spec.node.length; ++v) {
      const n = 3 * spec.node[v], by = 1 / Math.max(Math.hypot(sum[n], sum[n + 1], sum[n + 2]), 1e-30);
      for (let i = 0; i < 3; ++i) normal[3 * v + i] = by * sum[n + i];
    }
  }

  // After a cut: `piece` per tetrahedron, -1 for one that is gone. Triangles with corners of different pieces go too.
  part(piece) {
    const { spec } = this;
    for (let t = 0; t < spec.tetrahedra; ++t) this.alive[t] = piece[t] >= 0 ? 1 : 0;
    const pieceOf = (v) => (spec.cell[v] < spec.tetrahedra ? piece[spec.cell[v]] : 0);
    this.triangles = spec.parts.map(({ first, triangles }) => {
      const left = [];
      for (let t = 0; t < triangles.length; t += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => pieceOf(first + triangles[t + k]));
        if (a >= 0 && a === b && a === c) left.push(triangles[t], triangles[t + 1], triangles[t + 2]);
      }
      return Uint32Array.from(left);
    });
    ++this.shape;
    this.findNormals();
  }

  // What there is to draw of each part.
  views() {
    const { spec } = this;
    return spec.parts.map(({ finish, colour, textured, first, count }, p) => {
      const own = (all, width) => all.subarray(width * first, width * (first + count));
      const view = {
        finish, colour, shape: this.shape, position: own(this.position, 3), normal: own(this.normal, 3),
        rest: own(spec.position, 3), scalar: own(this.displacement, 1),
        marked: this.marked && own(this.marked, 1), triangles: this.triangles[p],
      };
      return textured ? { ...view, image: own(spec.image, 2), texture: spec.texture } : view;
    }).filter((view) => view.triangles.length > 0);
  }
}

// The affine map that is nearest to what the nodes of the triangles have done; the identity without triangles.
class Frame {
  constructor({ cells, tetrahedra }, rest) {
    this.nodes = [...new Set(Array.from(cells.subarray(4 * tetrahedra)).filter((n) => n >= 0))];
    this.map = Float64Array.of(1, 0, 0, 0, 1, 0, 0, 0, 1);
    this.inverse = this.map;
    this.shift = [0, 0, 0];
    this.middle = this.middleOf(rest);
    const spread = new Float64Array(9);
    this.each(rest, this.middle, (x) => { for (let i = 0; i < 9; ++i) spread[i] += x[i % 3] * x[Math.floor(i / 3)]; });
    const size = (spread[0] + spread[4] + spread[8]) / 3;
    if (!(determinant(spread) > 1e-9 * size ** 3)) return;
    const dual = invert(spread);
    this.dual = new Float64Array(3 * this.nodes.length);
    this.each(rest, this.middle, (x, at) => this.dual.set(times(dual, ...x), 3 * at));
  }

  middleOf(p) {
    const sum = [0, 0, 0];
    for (const n of this.nodes) for (let i = 0; i < 3; ++i) sum[i] += p[3 * n + i] / this.nodes.length;
    return sum;
  }

  each(p, middle, act) {
    this.nodes.forEach((n, at) => act([p[3 * n] - middle[0], p[3 * n + 1] - middle[1], p[3 * n + 2] - middle[2]], at));
  }

  follow(p) {
    const { dual } = this;
    if (!dual) return;
    const middle = this.middleOf(p), map = new Float64Array(9);
    this.each(p, middle, (x, at) => {
      for (let i = 0; i < 9; ++i) map[i] += x[i % 3] * dual[3 * at + Math.floor(i / 3)];
    });
    this.map = determinant(map) > leastVolume ? map : Float64Array.of(1, 0, 0, 0, 1, 0, 0, 0, 1);
    this.inverse = invert(this.map);
    const moved = times(this.map, ...this.middle);
    for (let i = 0; i < 3; ++i) this.shift[i] = middle[i] - moved[i];
  }

  fromWorld(from, at, to) {
    const { inverse: m, shift } = this;
    const x = from[at] - shift[0], y = from[at + 1] - shift[1], z = from[at + 2] - shift[2];
    for (let i = 0; i < 3; ++i) to[at + i] = m[i] * x + m[3 + i] * y + m[6 + i] * z;
  }

  toWorld(x, y, z, to, at) {
    const { map: m, shift } = this;
    for (let i = 0; i < 3; ++i) to[at + i] = m[i] * x + m[3 + i] * y + m[6 + i] * z + shift[i];
  }
}

const times = (m, x, y, z) => [0, 1, 2].map((i) => m[i] * x + m[3 + i] * y + m[6 + i] * z);

function determinant(m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[3] * (m[1] * m[8] - m[2] * m[7]) + m[6] * (m[1] * m[5] - m[2] * m[4]);
}

function invert(m) {
  const by = 1 / determinant(m);
  return Float64Array.of(
    by * (m[4] * m[8] - m[5] * m[7]), by * (m[2] * m[7] - m[1] * m[8]), by * (m[1] * m[5] - m[2] * m[4]),
    by * (m[5] * m[6] - m[3] * m[8]), by * (m[0] * m[8] - m[2] * m[6]), by * (m[2] * m[3] - m[0] * m[5]),
    by * (m[3] * m[7] - m[4] * m[6]), by * (m[1] * m[6] - m[0] * m[7]), by * (m[0] * m[4] - m[1] * m[3]));
}
