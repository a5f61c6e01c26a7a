// As render_node/refine.hpp: triangles split in four, new vertices on the curved patch that the corner normals span.
// Corners stay where they are.
const minCosine = 0.64;  // 50 degrees between two faces of a vertex

// Area-weighted unit normals per vertex.
export function vertexNormals(position, triangles, normal) {
  normal.fill(0);
  for (let t = 0; t < triangles.length; t += 3) {
    const [nx, ny, nz] = faceNormal(position, triangles, t);
    for (let k = 0; k < 3; ++k) {
      const v = 3 * triangles[t + k];
      normal[v] += nx;
      normal[v + 1] += ny;
      normal[v + 2] += nz;
    }
  }
  for (let v = 0; v < normal.length; v += 3) normalise(normal, v);
}

function faceNormal(p, triangles, t) {
  const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
  const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
  const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
  return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}

function normalise(n, v) {
  const length = Math.hypot(n[v], n[v + 1], n[v + 2]);
  const by = length > 0 ? 1 / length : 0;
  n[v] *= by;
  n[v + 1] *= by;
  n[v + 2] *= by;
}

function levelsFor(triangles, most) {
  let levels = 0;
  for (; levels < 2 && 4 * triangles <= most; ++levels) triangles *= 4;
  return levels;
}

export class Refinement {
  // `rest` [m] of the coarse vertices: what lies at a crease stays flat.
  constructor(triangles, rest, mostTriangles) {
    this.coarse = rest.length / 3;
    this.triangles = Uint32Array.from(triangles);
    this.coarseTriangles = this.triangles;
    this.ends = [];
    this.crease = creases(this.triangles, rest);
    for (let level = levelsFor(triangles.length / 3, mostTriangles); level > 0; --level) this.split();
    this.vertices = this.coarse + this.ends.length / 2;
  }

  split() {
    const middles = new Map(), finer = new Uint32Array(4 * this.triangles.length);
    const middle = (a, b) => {
      const low = Math.min(a, b), high = Math.max(a, b), key = low * 0x4000000 + high;
      let m = middles.get(key);
      if (m === undefined) {
        m = this.coarse + this.ends.length / 2;
        middles.set(key, m);
        this.ends.push(low, high);
        this.crease.push(this.crease[low] && this.crease[high]);
      }
      return m;
    };
    for (let t = 0; t < this.triangles.length; t += 3) {
      const a = this.triangles[t], b = this.triangles[t + 1], c = this.triangles[t + 2];
      const ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.set([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], 4 * t);
    }
    this.triangles = finer;
  }

  // Fills in what lies beyond the coarse part of positions [m] and unit normals.
  apply(p, n) {
    let k = 3 * this.coarse;
    for (let e = 0; e < this.ends.length; e += 2, k += 3) {
      const va = this.ends[e], vb = this.ends[e + 1], a = 3 * va, b = 3 * vb;
      const sharp = this.crease[va] || this.crease[vb];
      const ex = p[b] - p[a], ey = p[b + 1] - p[a + 1], ez = p[b + 2] - p[a + 2];
      const riseA = sharp ? 0 : 0.125 * (ex * n[a] + ey * n[a + 1] + ez * n[a + 2]);
      const riseB = sharp ? 0 : -0.125 * (ex * n[b] + ey * n[b + 1] + ez * n[b + 2]);
      const sx = n[a] + n[b], sy = n[a + 1] + n[b + 1], sz = n[a + 2] + n[b + 2];
      const turn = sharp ? 0 : 2 * (ex * sx + ey * sy + ez * sz) / Math.max(ex * ex + ey * ey + ez * ez, 1e-20);
      for (let i = 0; i < 3; ++i)
        p[k + i] = 0.5 * (p[a + i] + p[b + i]) - riseA * n[a + i] - riseB * n[b + i];
      n[k] = sx - turn * ex;
      n[k + 1] = sy - turn * ey;
      n[k + 2] = sz - turn * ez;
      normalise(n, k);
    }
  }

  // The same for three numbers per vertex, by the mean of the edge.
  average(values) {
    let k = 3 * this.coarse;
    for (let e = 0; e < this.ends.length; e += 2)
      for (let i = 0; i < 3; ++i)
        values[k++] = 0.5 * (values[3 * this.ends[e] + i] + values[3 * this.ends[e + 1] + i]);
  }
}

function creases(triangles, rest) {
  const count = rest.length / 3, faces = Array.from({ length: count }, () => []);
  for (let t = 0; t < triangles.length; t += 3) {
    const normal = faceNormal(rest, triangles, t);
    normalise(normal, 0);
    for (let k = 0; k < 3; ++k) faces[triangles[t + k]].push(normal);
  }
  const sharp = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < minCosine;
  return faces.map((of) => of.some((a) => of.some((b) => sharp(a, b))));
}
