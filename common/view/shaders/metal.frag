// Brushed steel at the working end, dark insulation further up the shaft.
in vec3 world;
in vec3 facing;
in vec3 sticky;   // tip frame: z along the shaft, handle to tip [m]
layout(location = 4) uniform vec4 colour;  // x: polish, 1 mirrors most, 0 is satin; w: length of the bare steel behind the tip [m]
layout(location = 5) uniform vec4 shaft;   // xyz: unit direction of the shaft
out vec4 pixel;
void main() {
  Lit lit = light_at(world);
  vec3 n = normalize(facing);
  vec3 h = normalize(lit.to_light + lit.to_eye);
  float nl = max(dot(n, lit.to_light), 0.0), nv = max(dot(n, lit.to_eye), 0.0), nh = max(dot(n, h), 0.0);
  float bare = smoothstep(-colour.w - 0.0004, -colour.w, sticky.z);
  float ring = 1.0 - 0.75 * (1.0 - smoothstep(0.0002, 0.0005, abs(sticky.z + 0.55 * colour.w)));
  float brush = 0.9 + 0.2 * noise(vec3(sticky.xy / 0.005, sticky.z / 0.0004));

  // Turned steel: a highlight that is narrow across the shaft and long along it, and a sharp one from the polish.
  float th = dot(shaft.xyz, h);
  float streak = pow(max(1.0 - th * th, 0.0), 2.0) * fifth(nh) * fifth(nh) * fifth(nh);
  float shine = 0.5 * streak * brush + 2.5 * gloss(nh, 0.09) + 0.5 * gloss(nh, 0.25);

  // What the steel mirrors: lit tissue ahead, the glow about the light, and the moist wall above, which catches it.
  vec3 mirror = reflect(-lit.to_eye, n);
  float ahead = smoothstep(0.0, 0.9, dot(mirror, scene.forward.xyz));
  float glow = smoothstep(-0.25, 1.0, dot(mirror, lit.to_light));
  vec3 room = vec3(0.16, 0.06, 0.05) * ahead + vec3(0.85, 0.86, 0.88) * glow * glow + vec3(0.05);
  float above = smoothstep(0.45, 0.80, dot(mirror, normalize(scene.up.xyz + 0.3 * scene.right.xyz)));
  room += vec3(1.15, 1.12, 1.10) * above;
  float edge = fifth(1.0 - nv);
  float satin = 1.0 - colour.x;
  vec3 steel = ((0.85 - 0.5 * satin) * room + vec3(0.18 + 0.75 * satin * nl) * nl * brush + vec3(1.0, 0.98, 0.95) * shine) * ring;
  vec3 sleeve = vec3(0.010) * nl + vec3(0.10) * pow(nh, 24.0) + room * (0.015 + 0.2 * edge);
  pixel = vec4(display(mix(sleeve, steel, bare) * min(lit.strength, 1.15)), 1.0);
}
