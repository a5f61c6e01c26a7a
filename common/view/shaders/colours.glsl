// A scale of even lightness steps from dark blue over green to yellow; least-squares polynomial of matplotlib's
// "viridis" (public domain), within 0.017 of it. x in [0,1]; display values.
vec3 scale_colour(float x) {
  x = clamp(x, 0.0, 1.0);
  vec3 c = vec3(-5.43208, 4.64157, 26.27211);
  c = c * x + vec3(4.75179, -13.74944, -65.32097);
  c = c * x + vec3(6.20374, 14.15396, 56.65630);
  c = c * x + vec3(-4.59993, -5.75824, -19.29181);
  c = c * x + vec3(-0.32724, 0.21481, 0.09198);
  c = c * x + vec3(0.10771, 1.39647, 1.38677);
  return c * x + vec3(0.27446, 0.00577, 0.33266);
}
