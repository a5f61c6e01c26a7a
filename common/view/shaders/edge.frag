out vec4 pixel;
void main() {
  pixel = vec4(0.03, 0.03, 0.04, 1.0);
}
