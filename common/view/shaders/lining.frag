// Peritoneum: a smooth, moist, pink sheet with fat shining through and fine vessels under it.
in vec3 world;
in vec3 facing;
in vec3 sticky;
layout(location = 4) uniform vec4 colour;
out vec4 pixel;
void main() {
  Lit lit = light_at(world);
  vec4 folds = noise_slope(sticky / 0.030);
  float fat = noise(sticky / 0.017 + folds.w);
  float field = noise(sticky / 0.024 + 2.0 * noise(sticky / 0.012));
  vec3 n = tilt(normalize(facing), 0.12 * folds.xyz);
  float vessel = max(1.0 - 22.0 * abs(field - 0.5), 0.0) * smoothstep(0.35, 0.7, folds.w);
  vec3 base = colour.rgb * mix(vec3(0.92, 0.90, 0.92), vec3(1.10, 1.30, 1.12), smoothstep(0.2, 0.9, fat));
  base *= 1.0 - vec3(0.12, 0.22, 0.15) * vessel;
  float nl = dot(n, lit.to_light), nv = max(dot(n, lit.to_eye), 0.0);
  const vec3 wrap = vec3(0.30, 0.15, 0.12);
  vec3 diffuse = max((nl + wrap) / (1.0 + wrap), 0.0);
  vec3 h = normalize(lit.to_light + lit.to_eye);
  float nh = max(dot(n, h), 0.0);
  float shine = 0.20 * gloss(nh, 0.06) + 0.10 * gloss(nh, 0.22);
  vec3 light = base * diffuse + vec3(1.0, 0.94, 0.90) * (shine + 0.04 * fifth(1.0 - nv));
  pixel = vec4(display(light * lit.strength + base * 0.006), 1.0);
}
