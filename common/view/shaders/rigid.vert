layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest;
layout(location = 0) uniform mat4 placement;
out vec3 world;
out vec3 facing;
out vec3 sticky;
void main() {
  world = (placement * vec4(position, 1.0)).xyz;
  facing = mat3(placement) * normal;
  sticky = rest;
  gl_Position = scene.view_projection * vec4(world, 1.0);
}
