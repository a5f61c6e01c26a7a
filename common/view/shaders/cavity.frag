// The wall of the cavity around the scene: a sphere behind everything, moist and far from the light.
in vec3 ray;
out vec4 pixel;
void main() {
  vec3 d = normalize(ray);
  float size = 2.4 * scene.eye.w;
  vec3 centre = scene.forward.xyz * scene.eye.w * 0.3;  // from the eye
  float b = dot(d, centre);
  vec3 p = d * (b + sqrt(max(b * b - dot(centre, centre) + size * size, 0.0)));
  vec3 q = (p + scene.eye.xyz) / scene.eye.w;
  float broad = noise(q * 1.1);
  const vec3 fold = vec3(2.0, 2.0, 3.1);
  vec4 folds = noise_slope(q * fold + 1.2 * broad), grains = noise_slope(q * 7.0 + folds.w);
  float fine = grains.w, grain = noise(q * 23.0);
  vec3 n = tilt(normalize(centre - p), 0.20 * fold * folds.xyz + 0.15 * grains.xyz);
  vec3 base = mix(vec3(0.20, 0.030, 0.020), vec3(0.40, 0.13, 0.075), 0.6 * broad + 0.4 * fine) * (0.8 + 0.3 * grain);
  vec3 l = normalize(scene.light.xyz - scene.eye.xyz - p);
  float nl = max(dot(n, l), 0.0);
  float shine = gloss(max(dot(n, normalize(l - d)), 0.0), 0.18);
  float fall = scene.eye.w * scene.eye.w / dot(p, p) * scene.forward.w * vignette();
  pixel = vec4(display((base * nl * nl + 0.05 * shine) * fall), 1.0);
}
