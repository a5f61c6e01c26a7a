// Smooth noise on the integer lattice: every lattice point gets a value in [0,1), blended by a cubic.
const uvec3 lattice_step = uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);

// A float in [1,2): the hash's upper bits become its mantissa.
float lattice(uint h) { return uintBitsToFloat((((h ^ (h >> 15)) * 0x7feb352du) >> 9) | 0x3f800000u); }

// xyz: gradient with respect to p; w: value.
vec4 noise_slope(vec3 p) {
  vec3 cell = floor(p);
  vec3 f = p - cell;
  vec3 slope = 6.0 * f * (1.0 - f);
  f = f * f * (3.0 - 2.0 * f);
  uvec3 a = uvec3(ivec3(cell)) * lattice_step;
  uvec3 b = a + lattice_step;
  uint aa = a.y ^ a.z, ba = b.y ^ a.z, ab = a.y ^ b.z, bb = b.y ^ b.z;
  vec4 left = vec4(lattice(a.x ^ aa), lattice(a.x ^ ba), lattice(a.x ^ ab), lattice(a.x ^ bb));
  vec4 rise = vec4(lattice(b.x ^ aa), lattice(b.x ^ ba), lattice(b.x ^ ab), lattice(b.x ^ bb)) - left;
  vec4 line = left + f.x * rise;
  vec2 front = line.xz + f.y * (line.yw - line.xz);
  vec2 along_x = mix(rise.xz, rise.yw, f.y), along_y = line.yw - line.xz;
  vec3 gradient = vec3(mix(along_x.x, along_x.y, f.z), mix(along_y.x, along_y.y, f.z), front.y - front.x);
  return vec4(slope * gradient, mix(front.x, front.y, f.z) - 1.0);
}

float noise(vec3 p) { return noise_slope(p).w; }
