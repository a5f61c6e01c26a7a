// The coarse patterns of tissue change little between vertices and are computed here.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest;
layout(location = 3) in float scalar;
#ifdef TEXTURED
layout(location = 4) in vec2 image_place;
out vec2 place;
#endif
out vec3 world;
out vec3 facing;
out vec3 sticky;   // rest position
out vec3 pattern;  // broad patches, the vessels' field, the scalar
out vec4 relief;   // mottles of a few mm; xyz: gradient [1/m]; w: value
void main() {
  world = position;
  facing = normal;
  vec4 broad = noise_slope(rest / 0.033);
  // The mottles wind about the patches: their gradient by the chain rule.
  vec4 middle = noise_slope(rest / 0.0083 + 2.0 * broad.w);
  relief.xyz = middle.xyz / 0.0083 + (middle.x + middle.y + middle.z) * 2.0 / 0.033 * broad.xyz;
  relief.w = middle.w - 0.5;
  // Winds over as much as vertices are apart, so that lines of one value have no corners.
  float vessel = noise(rest / 0.024 + 1.3 * noise(rest / 0.026));
#ifdef TEXTURED
  place = image_place;
#endif
  sticky = rest;
  pattern = vec3(broad.w, vessel, scalar);
  gl_Position = scene.view_projection * vec4(position, 1.0);
}
