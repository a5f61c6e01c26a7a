in vec2 place;
in vec4 paint;
layout(binding = 0) uniform sampler2D glyphs;
out vec4 pixel;
void main() {
  if (paint.w < 0.0) {
    pixel = vec4(scale_colour(paint.x), 1.0);
    return;
  }
  pixel = vec4(paint.rgb, paint.a * texture(glyphs, place).r);
}
