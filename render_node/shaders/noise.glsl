// Smooth noise on the integer lattice: every lattice point gets a value in [0,1), blended by a cubic.
const uvec3 lattice_step = uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);

// A float in [1,2): the hash's upper bits become its mantissa.
float lattice(uint h) { return uintBitsToFloat((((h ^ (h >> 15)) * 0x7feb352du) >> 9) | 0x3f800000u); }

float noise(vec3 p) {
  vec3 cell = floor(p);
  vec3 f = p - cell;
  f = f * f * (3.0 - 2.0 * f);
  uvec3 a = uvec3(ivec3(cell)) * lattice_step;
  uvec3 b = a + lattice_step;
  uint aa = a.y ^ a.z, ba = b.y ^ a.z, ab = a.y ^ b.z, bb = b.y ^ b.z;
  float x0 = mix(lattice(a.x ^ aa), lattice(b.x ^ aa), f.x);
  float x1 = mix(lattice(a.x ^ ba), lattice(b.x ^ ba), f.x);
  float x2 = mix(lattice(a.x ^ ab), lattice(b.x ^ ab), f.x);
  float x3 = mix(lattice(a.x ^ bb), lattice(b.x ^ bb), f.x);
  return mix(mix(x0, x1, f.y), mix(x2, x3, f.y), f.z) - 1.0;
}

// How much of a pattern of the given wavelength [m] a pixel of the given footprint [m] can still show.
float visible(float wavelength, float footprint) { return clamp(wavelength / footprint * 0.5 - 0.5, 0.0, 1.0); }
