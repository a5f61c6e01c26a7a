// Bone under a thin moist film.
in vec3 world;
in vec3 facing;
in vec3 sticky;
layout(location = 4) uniform vec4 colour;
out vec4 pixel;
void main() {
  Lit lit = light_at(world);
  vec3 n0 = normalize(facing);
  float stain = noise(sticky / 0.023);
  float vein = noise(sticky / 0.009 + 3.0 * stain);
  const vec3 strand = vec3(0.0045, 0.003, 0.003);
  vec4 strands = noise_slope(sticky / strand + stain), pores = noise_slope(sticky / 0.0011);
  float fibre = strands.w - 0.5, pore = pores.w - 0.5;
  vec3 n = tilt(n0, 0.00035 / strand * strands.xyz + 0.03 * pores.xyz);
  // Between the corners of a rim's triangle the normal looks away from the eye, and ribs would have dotted black rims.
  n = normalize(n + max(0.0, 0.45 - dot(n, lit.to_eye)) * lit.to_eye);
  float moist = smoothstep(0.30, 0.95, 0.6 * stain + 0.4 * vein);
  vec3 base = mix(colour.rgb * vec3(1.0, 0.88, 0.74), colour.rgb * vec3(0.70, 0.34, 0.26), moist);
  base *= 0.92 + 0.25 * fibre + 0.15 * pore;
  float nl = max(dot(n, lit.to_light), 0.0), nv = max(dot(n, lit.to_eye), 0.0);
  vec3 h = normalize(lit.to_light + lit.to_eye);
  float shine = 0.22 * gloss(max(dot(n, h), 0.0), 0.12) * (0.4 + 0.8 * moist);
  vec3 light = base * 0.8 * nl * (0.35 + 0.65 * nv) + vec3(1.0, 0.95, 0.9) * shine;
  pixel = vec4(display(light * lit.strength + base * 0.005), 1.0);
}
