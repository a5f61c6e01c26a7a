// Inner side and cut rims of a duct: a soft, wet lining in low folds across it, stained by bile.
in vec3 world;
in vec3 facing;
in vec3 sticky;
in vec2 pattern;
layout(location = 4) uniform vec4 colour;
out vec4 pixel;
void main() {
  Lit lit = light_at(world);
  vec3 n0 = facing * inversesqrt(dot(facing, facing));
  vec4 fold = noise_slope(sticky / vec3(0.0026, 0.0026, 0.0013) + 1.5 * pattern.x);
  vec3 side = cross(n0, lit.to_eye);
  vec3 n = tilt(n0, 0.10 * fold.z * side + 0.08 * (fold.w - 0.5) * lit.to_eye);
  vec3 base = colour.rgb * (0.80 + 0.40 * fold.w);
  base *= mix(vec3(1.0, 0.80, 0.82), vec3(1.02, 1.06, 0.74), clamp(2.0 * pattern.y - 0.7, 0.0, 1.0));
  float nl = dot(n, lit.to_light), nv = max(dot(n, lit.to_eye), 0.0);
  const vec3 wrap = vec3(0.34, 0.20, 0.14);
  vec3 diffuse = max((nl + wrap) / (1.0 + wrap), 0.0) * (0.35 + 0.65 * nv);
  vec3 h = lit.to_light + lit.to_eye;
  float nh = max(dot(n, h) * inversesqrt(dot(h, h)), 0.0);
  float shine = 0.9 * gloss(nh, 0.05) + 0.15 * gloss(nh, 0.25);
  float shade = lit.strength * instrument_shade(world, n0, lit);
  vec3 light = 0.9 * base * diffuse + vec3(1.0, 0.95, 0.90) * shine;
  pixel = vec4(display(light * shade + base * 0.006), 1.0);
}
