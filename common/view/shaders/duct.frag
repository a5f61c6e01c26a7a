// Outer side of a duct: a pale, moist sheath with fibres along it and fine vessels that wind about them.
in vec3 world;
in vec3 facing;
in vec3 sticky;
in vec2 pattern;
layout(location = 4) uniform vec4 colour;
out vec4 pixel;
void main() {
  Lit lit = light_at(world);
  vec3 n0 = facing * inversesqrt(dot(facing, facing));
  const vec3 weave = vec3(0.00048, 0.00048, 0.0058), tree = vec3(0.0024, 0.0024, 0.0095);  // [m]
  vec4 fibre = noise_slope(sticky / weave + vec3(2.5, 2.5, 0.0) * pattern.x);
  vec4 bed = noise_slope(sticky / tree + 2.0 * pattern.y);
  // The slopes belong to the straightened tube; across it only their size counts, which a bend does not change much.
  vec3 side = cross(n0, lit.to_eye);
  vec3 n = tilt(n0, 0.20 * (fibre.x + fibre.y) * side + 0.30 * (bed.w - 0.5) * (lit.to_eye - n0 * dot(lit.to_eye, n0)));

  float strand = fibre.w - 0.5;
  vec3 base = colour.rgb * (1.0 + 0.45 * strand + 0.6 * (pattern.x - 0.5));
  base *= 1.0 + vec3(0.06, 0.26, 0.24) * clamp(4.0 * strand - 0.4, 0.0, 1.0);                           // white strands
  base *= 1.0 + vec3(0.12, 0.10, -0.18) * clamp(3.0 * (pattern.x + 0.4 * bed.w - 0.72), 0.0, 1.0);      // fat shines through
  float vessel = clamp(1.0 - 16.0 * abs(bed.w - 0.5 + 0.07 * strand), 0.0, 1.0) * clamp(4.0 * pattern.y - 1.9, 0.0, 1.0);
  base *= 1.0 - vec3(0.20, 0.58, 0.52) * vessel;

  float nl = dot(n, lit.to_light), nv = max(dot(n, lit.to_eye), 0.0);
  const vec3 wrap = vec3(0.30, 0.14, 0.10);
  vec3 diffuse = max((nl + wrap) / (1.0 + wrap), 0.0) * (0.5 + 0.5 * nv);
  vec3 h = lit.to_light + lit.to_eye;
  float nh = max(dot(n, h) * inversesqrt(dot(h, h)), 0.0);
  float film = 0.7 + 0.6 * pattern.x + 0.8 * strand;
  float shine = (1.05 * gloss(nh, 0.035) + 0.26 * gloss(nh, 0.14) + 0.05 * gloss(nh, 0.4)) * film;
  float rim = 0.10 * fifth(1.0 - nv);
  float shade = lit.strength * instrument_shade(world, n0, lit);
  vec3 light = 0.95 * base * diffuse + vec3(1.0, 0.95, 0.91) * shine + vec3(0.60, 0.36, 0.28) * rim;
  pixel = vec4(display(light * shade + base * 0.008), 1.0);
}
