// Where a ray meets the bodies: {point, normal} of the nearest triangle that faces it; undefined for none.
import { add, dot, scale, unit } from './vec.js';

// What is there now, and where tissue comes back to.
export function snapshot(bodies) {
  return bodies.filter((body) => body.spec.finish !== 'plastic').flatMap((body) => body.surfaces())
    .map((of) => ({ ...of, position: of.position.slice(), normal: of.normal.slice() }));
}

export function pick(surfaces, ray) {
  let best;
  for (const surface of surfaces)
    for (let t = 0; t < surface.triangles.length; t += 3) {
      const hit = meet(surface, t, ray);
      if (hit && !(best && best.distance <= hit.distance)) best = hit;
    }
  if (!best) return undefined;
  return { point: add(ray.from, scale(best.distance, ray.along)), normal: normalAt(best) };
}

function meet(surface, t, { from, along }) {
  const p = surface.position, i = 3 * surface.triangles[t], j = 3 * surface.triangles[t + 1];
  const k = 3 * surface.triangles[t + 2];
  const ax = p[j] - p[i], ay = p[j + 1] - p[i + 1], az = p[j + 2] - p[i + 2];
  const bx = p[k] - p[i], by = p[k + 1] - p[i + 1], bz = p[k + 2] - p[i + 2];
  const hx = along[1] * bz - along[2] * by, hy = along[2] * bx - along[0] * bz, hz = along[0] * by - along[1] * bx;
  const volume = ax * hx + ay * hy + az * hz;
  if (!(volume > 1e-18)) return undefined;  // seen from behind, or edge on
  const sx = from[0] - p[i], sy = from[1] - p[i + 1], sz = from[2] - p[i + 2];
  const u = (sx * hx + sy * hy + sz * hz) / volume;
  if (u < 0 || u > 1) return undefined;
  const qx = sy * az - sz * ay, qy = sz * ax - sx * az, qz = sx * ay - sy * ax;
  const v = (along[0] * qx + along[1] * qy + along[2] * qz) / volume;
  if (v < 0 || u + v > 1) return undefined;
  const distance = (bx * qx + by * qy + bz * qz) / volume;
  return distance > 0 ? { distance, surface, corners: [i, j, k], weights: [1 - u - v, u, v] } : undefined;
}

function normalAt({ surface, corners, weights }) {
  let sum = [0, 0, 0];
  corners.forEach((c, n) => { sum = add(sum, scale(weights[n], surface.normal.slice(c, c + 3))); });
  return unit(sum);
}

// Distance [m] of a point from a line.
export function fromLine(point, on, along) {
  const d = [point[0] - on[0], point[1] - on[1], point[2] - on[2]], s = dot(d, along);
  return Math.sqrt(Math.max(0, dot(d, d) - s * s));
}
