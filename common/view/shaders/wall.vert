// A thin wall and what is led into it. The rest positions are those of the straightened tube: z runs along it.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest;
out vec3 world;
out vec3 facing;
out vec3 sticky;   // rest position
out vec2 pattern;  // broad patches; how dense the vessels are
void main() {
  world = position;
  facing = normal;
  sticky = rest;
  pattern = vec2(noise(rest / vec3(0.006, 0.006, 0.011)), noise(rest / vec3(0.010, 0.010, 0.017) + 7.5));
  gl_Position = scene.view_projection * vec4(position, 1.0);
}
