import { markedColour } from './marked.js';

// The project's shaders in the browser's dialect. They are written for GLSL 4.5; here uniforms have no places of their
// own, and numbers need a precision.
const head = '#version 300 es\nprecision highp float;\nprecision highp int;\n';

export function inThisDialect(text) {
  return text
    .replace(/layout\(std140, binding = \d+\)/g, 'layout(std140)')
    .replace(/layout\((?:location|binding) = \d+\) uniform/g, 'uniform');
}

const arrowVertex = `layout(location = 0) in vec3 position;
uniform mat4 placement;
out vec3 place;
void main() {
  place = (placement * vec4(position, 1.0)).xyz;
  gl_Position = scene.view_projection * vec4(place, 1.0);
}`;
// Lit from above the camera's left shoulder, so that an arrow towards the eye is seen as one.
const arrowFragment = `uniform float share;
in vec3 place;
out vec4 pixel;
void main() {
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  normal *= sign(dot(normal, scene.eye.xyz - place));
  vec3 to_light = normalize(normalize(scene.up.xyz) - 0.7 * normalize(scene.right.xyz) - 0.8 * scene.forward.xyz);
  pixel = vec4((0.35 + 0.65 * max(dot(normal, to_light), 0.0)) * scale_colour(share), 1.0);
}`;
// A veil over what is to be cut off, with a line about it.
const markedVertex = `layout(location = 0) in vec3 position;
layout(location = 5) in float marked;
out float inside;
void main() {
  inside = marked;
  gl_Position = scene.view_projection * vec4(position, 1.0);
}`;
const markedFragment = `in float inside;
out vec4 pixel;
void main() {
  float from_border = abs(inside) * gl_FragCoord.w / scene.right.w;  // [pixel], of a surface that faces the camera
  float wide = max(1.0, scene.viewport.y / 400.0);
  float line = 1.0 - smoothstep(wide, wide + 1.0, from_border);
  pixel = vec4(${markedColour.map((c) => c.toFixed(2)).join()}, max(0.9 * line, inside > 0.0 ? 0.2 : 0.0));
}`;
const coverVertex = `void main() {
  gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}`;
// What stands still, drawn before: colour and depth.
const coverFragment = `uniform sampler2D colours, depths;
out vec4 pixel;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  pixel = texelFetch(colours, at, 0);
  gl_FragDepth = texelFetch(depths, at, 0).r;
}`;
const legendFragment = `uniform float height;
out vec4 pixel;
void main() { pixel = vec4(scale_colour(gl_FragCoord.y / height), 1.0); }`;

// Programs by what they draw, made when they are first needed.
export class Programs {
  constructor(gl, sources) {
    this.gl = gl;
    this.sources = Object.fromEntries(Object.entries(sources).map(([name, text]) => [name, inThisDialect(text)]));
    this.made = new Map();
  }

  // Begins what will be needed; the browser compiles several at a time.
  prepare(name, tools = 0, variant = '') {
    const key = `${name} ${variant} ${tools}`;
    if (!this.made.has(key)) this.made.set(key, this.begin(name, ...this.texts(name, variant, tools)));
    return key;
  }

  // `variant`: '', 'BY_SCALAR' or 'TEXTURED'.
  get(name, tools = 0, variant = '') {
    const key = this.prepare(name, tools, variant), made = this.made.get(key);
    if (!made.ready) this.made.set(key, this.finish(made));
    return this.made.get(key);
  }

  texts(name, variant, tools) {
    const s = this.sources;
    const start = head + (variant && `#define ${variant}\n`) + `#define TOOLS ${tools}\n` + s.scene;
    const lit = start + s.noise + s.light;
    if (name === 'arrow') return [start + arrowVertex, start + s.colours + arrowFragment];
    if (name === 'marked') return [start + markedVertex, start + markedFragment];
    if (name === 'cover') return [head + coverVertex, head + 'precision highp sampler2D;\n' + coverFragment];
    if (name === 'legend') return [head + coverVertex, head + s.colours + legendFragment];
    if (name === 'cavity') return [start + s.cavity_vert, lit + s.cavity_frag];
    if (name === 'tissue') return [start + s.noise + s.tissue_vert, lit + s.colours + s.tissue_frag];
    if (name === 'membrane') return [start + s.noise + s.tissue_vert, lit + s.membrane_frag];
    const rigid = name === 'bone' || name === 'lining' || name === 'metal';
    return [rigid ? start + s.rigid_vert : start + s.noise + s.wall_vert, lit + s[`${name}_frag`]];
  }

  begin(name, vertex, fragment) {
    const { gl } = this, program = gl.createProgram();
    const shaders = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].map(([type, text]) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    gl.linkProgram(program);
    return { name, program, shaders };
  }

  finish({ name, program, shaders }) {
    const { gl } = this;
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      const said = [gl.getProgramInfoLog(program), ...shaders.map((shader) => gl.getShaderInfoLog(shader))];
      throw new Error(`${name}: ${said.join(' ')}`);
    }
    const block = gl.getUniformBlockIndex(program, 'SceneBlock');
    if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, block, 0);
    const at = (uniform) => gl.getUniformLocation(program, uniform);
    return {
      ready: true, program, placement: at('placement'), colour: at('colour'), shaft: at('shaft'), share: at('share'),
      colours: at('colours'), depths: at('depths'), height: at('height'), image: at('image'),
    };
  }
}
