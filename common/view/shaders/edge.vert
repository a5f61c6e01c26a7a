// The wires of a mesh, drawn a little nearer than its faces.
layout(location = 0) in vec3 position;
void main() {
  gl_Position = scene.view_projection * vec4(mix(position, scene.eye.xyz, 0.002), 1.0);
}
