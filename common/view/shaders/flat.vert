// Overlay: positions in pixels from the upper left corner.
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 tint;   // w: opacity; w < 0: the scale's colour at x
out vec2 place;
out vec4 paint;
void main() {
  place = texel;
  paint = tint;
  vec2 p = position / scene.viewport.xy * 2.0 - 1.0;
  gl_Position = vec4(p, 0.0, 1.0);
}
