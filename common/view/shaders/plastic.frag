// A catheter: pale, smooth plastic through which a little light comes, with a mark every 10 mm from its tip, a wide one every 50.
in vec3 world;
in vec3 facing;
in vec3 sticky;  // z: distance from the tip, negative [m]
in vec2 pattern;
layout(location = 4) uniform vec4 colour;
out vec4 pixel;
void main() {
  Lit lit = light_at(world);
  vec3 n = facing * inversesqrt(dot(facing, facing));
  float z = -sticky.z;
  float tens = abs(fract(z / 0.010 + 0.5) - 0.5) * 0.010, fifties = abs(fract(z / 0.050 + 0.5) - 0.5) * 0.050;
  float mark = max(1.0 - smoothstep(0.00030, 0.00050, tens), 1.0 - smoothstep(0.00085, 0.00105, fifties)) * step(0.004, z);
  float nl = dot(n, lit.to_light), nv = max(dot(n, lit.to_eye), 0.0);
  vec3 base = mix(colour.rgb, vec3(0.010, 0.014, 0.020), 0.92 * mark);
  const vec3 wrap = vec3(0.45, 0.50, 0.55);
  vec3 diffuse = max((nl + wrap) / (1.0 + wrap), 0.0);
  vec3 h = lit.to_light + lit.to_eye;
  float nh = max(dot(n, h) * inversesqrt(dot(h, h)), 0.0);
  float shine = 1.1 * gloss(nh, 0.04) + 0.16 * gloss(nh, 0.22);
  // The wall of the tube is clearer at its edges, where more of the surroundings comes through.
  vec3 through = vec3(0.30, 0.16, 0.13) * (1.0 - nv) * (1.0 - nv) + vec3(0.25) * fifth(1.0 - nv);
  float shade = lit.strength * instrument_shade(world, n, lit);
  vec3 light = 0.75 * base * diffuse * (0.55 + 0.45 * nv) + through * (1.0 - 0.7 * mark) * 0.6 + vec3(1.0, 0.98, 0.96) * shine;
  pixel = vec4(display(light * shade + base * 0.008), 1.0);
}
