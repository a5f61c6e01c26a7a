// One light beside the camera, as at the tip of an endoscope.
struct Lit {
  vec3 to_eye;     // unit
  vec3 to_light;   // unit
  float distance;  // to the light [m]
  float strength;  // fall-off and vignette
};

float vignette() {
  vec2 p = gl_FragCoord.xy * scene.viewport.z - scene.viewport.xy * (0.5 * scene.viewport.z);
  return 1.0 - 0.20 * min(dot(p, p), 3.0);
}

Lit light_at(vec3 p) {
  vec3 e = scene.eye.xyz - p, l = scene.light.xyz - p;
  float near = inversesqrt(dot(l, l));
  float d = scene.eye.w * near;
  return Lit(e * inversesqrt(dot(e, e)), l * near, 1.0 / near, scene.forward.w * min(d * d, 4.0) * vignette());
}

// TOOLS is a constant, so that the loop unrolls: indices known at run time only cost more than all the rest.
// What the instruments leave of the light at p: their shadow, and the dark between them and a surface near them.
float instrument_shade(vec3 p, vec3 n, Lit lit) {
  float shade = 1.0;
  for (int i = 0; i < TOOLS; ++i) {
    Tool tool = scene.tools[i];
    vec3 from_tip = p - tool.tip.xyz;
    float s = clamp(dot(from_tip, tool.shaft.xyz) * tool.across.w, 0.0, 1.0);
    vec3 d = s * tool.shaft.xyz - from_tip;
    float r = s > 0.02 ? tool.shaft.w : tool.tip.w;
    shade *= 1.0 - 0.7 * min(2.0 * r * r / dot(d, d), 1.0);

    float x = min(-dot(lit.to_light, tool.along.xyz), 0.0), y = dot(lit.to_light, tool.across.xyz);
    float closeness = -dot(lit.to_light, tool.near.xyz);
    float radius = (x < 0.0 ? tool.tip.w : tool.shaft.w) * closeness;
    float behind = clamp((lit.distance * closeness - 1.0) * 30.0, 0.0, 1.0);
    float off = (x * x + y * y) / (radius * radius);
    shade *= 1.0 - 0.5 * behind * clamp(1.9 - 1.1 * off, 0.0, 1.0);
  }
  return shade;
}

// Normal of a surface on which a height with the gradient `slope` [1] lies.
vec3 tilt(vec3 n, vec3 slope) {
  vec3 bent = n * (1.0 + dot(slope, n)) - slope;
  return bent * inversesqrt(dot(bent, bent));
}

// Microfacet lobe (GGX) at the half vector; alpha: squared roughness. Its top is 1.
float gloss(float nh, float alpha) {
  float a2 = alpha * alpha;
  float d = nh * nh * (a2 - 1.0) + 1.0;
  d = a2 / d;
  return d * d;
}

float fifth(float x) {
  float x2 = x * x;
  return x2 * x2 * x;
}

// Linear light to picture values: the display's curve with a shoulder that ends level at white.
vec3 display(vec3 c) {
  vec3 s = min(sqrt(c), 1.5);
  return s - (4.0 / 27.0) * s * s * s;
}
