// Serous membrane, smooth and wet, over what has a colour of its own: gall bladder, vessel, duct.
in vec3 world;
in vec3 facing;
in vec3 sticky;
in vec3 pattern;
in vec4 relief;
layout(location = 4) uniform vec4 colour;
out vec4 pixel;
void main() {
  Lit lit = light_at(world);
  vec3 n0 = facing * inversesqrt(dot(facing, facing));
  vec4 grain = noise_slope(sticky / 0.0034 + relief.w);
  float fine = grain.w - 0.5;
  const float high = 0.0003, low = 0.00005;  // of the mottles and the grain [m]
  vec3 n = tilt(n0, high * relief.xyz + low / 0.0034 * grain.xyz);

  vec3 base = colour.rgb * (1.0 + 0.30 * (pattern.x - 0.5) + 0.25 * relief.w + 0.12 * fine);
  float bed = noise(sticky / 0.0060 + 2.0 * pattern.y);
  float vessel = clamp(1.0 - 20.0 * abs(bed - 0.5), 0.0, 1.0) * clamp(3.0 * pattern.x - 1.1, 0.0, 1.0);
  base = mix(base, vec3(0.28, 0.04, 0.03), 0.35 * vessel);

  float nl = dot(n, lit.to_light), nv = max(dot(n, lit.to_eye), 0.0);
  const vec3 wrap = vec3(0.26, 0.16, 0.12);
  vec3 diffuse = max((nl + wrap) / (1.0 + wrap), 0.0) * (0.45 + 0.55 * nv);
  vec3 h = lit.to_light + lit.to_eye;
  float nh = max(dot(n, h) * inversesqrt(dot(h, h)), 0.0);
  float shine = 1.2 * gloss(nh, 0.03) + 0.30 * gloss(nh, 0.12) + 0.05 * gloss(nh, 0.4);
  float rim = 0.12 * fifth(1.0 - nv);
  float shade = lit.strength * instrument_shade(world, n0, lit);
  vec3 light = 1.2 * base * diffuse + vec3(1.0, 0.96, 0.92) * shine + vec3(0.50, 0.36, 0.30) * rim;
  pixel = vec4(display(light * shade + base * 0.008), 1.0);
}
