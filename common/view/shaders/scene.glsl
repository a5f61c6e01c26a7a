// What every shader knows of the frame. Mirrors struct SceneBlock in scene_block.hpp.
const int max_tools = 8;
struct Tool {
  vec4 tip;     // xyz: centre of the tip [m]; w: its radius [m]
  vec4 shaft;   // xyz: from the tip's centre to the far end of the shaft [m]; w: radius of the shaft [m]
  vec4 across;  // xyz: unit normal of the plane through light and shaft; w: 1 / squared length of the shaft
  vec4 along;   // xyz: unit, in that plane, across the ray to the tip, towards the shaft
  vec4 near;    // xyz: its product with a unit ray from the light is 1 / distance of the shaft on that ray [1/m]
};
layout(std140, binding = 0) uniform SceneBlock {
  mat4 view_projection;
  vec4 eye;       // xyz [m]; w: distance at which the light has its full strength [m]
  vec4 right;     // xyz: half the picture's width at distance 1; w: size of a pixel at distance 1
  vec4 up;        // xyz: half the picture's height at distance 1; w: largest scalar of the legend [m]
  vec4 forward;   // xyz: unit; w: brightness
  vec4 light;     // xyz [m]
  vec4 viewport;  // width, height [pixel]; 2 / height; 1, or -1 where the picture is drawn upside down
  Tool tools[max_tools];
} scene;
