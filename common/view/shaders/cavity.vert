// One triangle over the whole picture, at the far plane.
out vec3 ray;
void main() {
  vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
  ray = scene.forward.xyz + p.x * scene.right.xyz + p.y * scene.viewport.w * scene.up.xyz;
  gl_Position = vec4(p, 1.0, 1.0);
}
