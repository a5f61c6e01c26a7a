// Bone under a thin moist film, and the lining of the cavity.
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
  float fibre = noise(sticky / vec3(0.0045, 0.003, 0.003) + stain) - 0.5;
  float pore = noise(sticky / 0.0011) - 0.5;
  vec3 n = bend(n0, world, 0.0005 * fibre + 0.00008 * pore);
  float moist = smoothstep(0.25, 0.80, 0.6 * stain + 0.4 * vein);
  vec3 base = mix(colour.rgb * vec3(1.0, 0.86, 0.70), colour.rgb * vec3(0.55, 0.20, 0.14), moist);
  base *= 0.85 + 0.45 * fibre + 0.35 * pore;
  float nl = max(dot(n, lit.to_light), 0.0), nv = max(dot(n, lit.to_eye), 0.0);
  vec3 h = normalize(lit.to_light + lit.to_eye);
  float shine = 0.22 * gloss(max(dot(n, h), 0.0), 0.12) * (0.4 + 0.8 * moist);
  vec3 light = base * 0.8 * nl * (0.35 + 0.65 * nv) + vec3(1.0, 0.95, 0.9) * shine;
  pixel = vec4(display(light * lit.strength + base * 0.005), 1.0);
}
