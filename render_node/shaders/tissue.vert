// The coarse patterns of tissue change little between vertices and are computed here.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest;
layout(location = 3) in float scalar;
out vec3 world;
out vec3 facing;
out vec3 sticky;   // rest position, around which the broad pattern winds
out vec3 pattern;  // broad patches, the vessels' field, the scalar
void main() {
  world = position;
  facing = normal;
  float broad = noise(rest / 0.033);
  float vessel = noise(rest / 0.021 + 3.0 * noise(rest / 0.013)) ;
  sticky = rest;
  pattern = vec3(broad, vessel, scalar);
  gl_Position = scene.view_projection * vec4(position, 1.0);
}
