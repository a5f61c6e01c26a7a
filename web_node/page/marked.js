// What of a body is to be cut off.
export const markedColour = [0.45, 1, 0.55];

// How far points at rest are inside a box [m], negative outside.
export function depthsIn([least, greatest], points) {
  const depths = new Float32Array(points.length / 3);
  for (let v = 0; v < depths.length; ++v) {
    depths[v] = Infinity;
    for (let i = 0; i < 3; ++i)
      depths[v] = Math.min(depths[v], points[3 * v + i] - least[i], greatest[i] - points[3 * v + i]);
  }
  return depths;
}
