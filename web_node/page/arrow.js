// The arrow of a force: a shaft and a head along z, of length 1.
import { cross, size, unit } from './vec.js';

// Lengths are shares of the camera's distance.
const around = 48, fullScale = 0.3, longest = 0.4, widest = 1;  // [N]: beyond it the scale of lengths stays
const leastShown = 0.02;  // share of the scale

export function arrowMesh() {
  const outline = [[0, 0], [0.03, 0], [0.03, 0.72], [0.085, 0.72], [0, 1]], position = [], triangles = [];
  for (const [r, z] of outline)
    for (let j = 0; j < around; ++j) {
      const angle = 2 * Math.PI * j / around;
      position.push(r * Math.cos(angle), r * Math.sin(angle), z);
    }
  for (let i = 0; i + 1 < outline.length; ++i)
    for (let j = 0; j < around; ++j) {
      const a = i * around + j, b = i * around + (j + 1) % around;
      triangles.push(a, b, b + around, a, b + around, a + around);
    }
  return { position: new Float32Array(position), triangles: new Uint32Array(triangles) };
}

// Where it stands; undefined for a force too small to show. `forceMax` [N]: the scale of its colour. `reach` [m] of the
// camera bounds its length.
export function arrowPlace(from, force, forceMax, reach) {
  const share = size(force) / Math.min(forceMax, widest);
  if (!(share > leastShown)) return undefined;
  const length = reach * Math.min(fullScale * share, longest), thick = Math.max(length, 0.08 * reach);
  const z = unit(force), x = unit(cross(Math.abs(z[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0], z)), y = cross(z, x);
  const column = (v, by) => [by * v[0], by * v[1], by * v[2], 0];
  return new Float32Array([...column(x, thick), ...column(y, thick), ...column(z, length), ...from, 1]);
}
