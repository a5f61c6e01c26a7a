// Wet parenchyma under a thin capsule. All patterns hang on rest positions, so they stretch with the tissue.
in vec3 world;
in vec3 facing;
in vec3 sticky;
in vec3 pattern;
in vec4 relief;
layout(location = 4) uniform vec4 colour;
#ifdef TEXTURED
in vec2 place;
layout(binding = 1) uniform sampler2D image;
#endif
out vec4 pixel;
void main() {
  Lit lit = light_at(world);
  vec3 n0 = facing * inversesqrt(dot(facing, facing));
  float middle = relief.w;
  vec4 grain = noise_slope(sticky / 0.0021 + 2.0 * middle);
  float fine = grain.w - 0.5;
  const float high = 0.0012, low = 0.00006;  // of the mottles and the grain [m]
  vec3 n = tilt(n0, (high + 2.0 * low * (grain.x + grain.y + grain.z)) * relief.xyz + low / 0.0021 * grain.xyz);

#ifdef BY_SCALAR
  vec3 base = scale_colour(pattern.z / scene.up.w);
  base *= base * 0.9;
  const float wetness = 0.3;
#elif defined(TEXTURED)
  // The image has the colours; the patterns only keep what is near from looking flat.
  float blotch = 0.5 * (pattern.x - 0.5) + 0.3 * middle;
  vec3 base = texture(image, place).rgb * (1.0 + 0.4 * blotch + 0.35 * fine);
  const float wetness = 1.0;
#else
  float blotch = 1.3 * (pattern.x - 0.5) + 0.45 * middle;
  // Light passes the capsule twice: what is dark in a colour gets darker.
  vec3 base = colour.rgb * (0.14 + 0.48 * colour.rgb) * (1.0 + 0.55 * blotch + 0.45 * fine);
  base *= 1.0 + vec3(0.10, 0.70, 0.45) * max(blotch + 0.35 * fine, 0.0);
  float vessel = clamp(1.0 - 24.0 * abs(pattern.y - 0.47), 0.0, 1.0) * clamp(3.0 * pattern.x - 1.0, 0.0, 1.0);
  base *= 1.0 - vec3(0.40, 0.60, 0.40) * vessel;
  const float wetness = 1.0;
#endif

  float nl = dot(n, lit.to_light), nv = max(dot(n, lit.to_eye), 0.0);
  // Light that enters the tissue comes out redder, and also beyond the edge of the lit side.
  const vec3 wrap = vec3(0.25, 0.08, 0.06);
  vec3 diffuse = max((nl + wrap) / (1.0 + wrap), 0.0) * (0.45 + 0.55 * nv);
  vec3 h = lit.to_light + lit.to_eye;
  float nh = max(dot(n, h) * inversesqrt(dot(h, h)), 0.0);
  float film = 0.8 + 0.9 * middle + 0.4 * fine;
  float shine = (1.3 * gloss(nh, 0.03) + 0.34 * gloss(nh, 0.13) + 0.045 * gloss(nh, 0.4)) * film * wetness;
  float rim = 0.10 * fifth(1.0 - nv) * wetness;

  float shade = lit.strength * instrument_shade(world, n0, lit);
  vec3 light = 1.35 * base * diffuse + vec3(1.0, 0.94, 0.90) * shine + vec3(0.60, 0.27, 0.20) * rim;
  pixel = vec4(display(light * shade + base * 0.008), 1.0);
}
