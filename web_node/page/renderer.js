// Draws the scene with WebGL 2 on a canvas.
import { Backdrop } from './backdrop.js';
import { GpuMesh } from './gpu_mesh.js';
import { Programs } from './programs.js';
import { Textures } from './textures.js';
import { axis, blockBytes, origin, sceneBlock } from './scene_block.js';
import { arrowMesh, arrowPlace } from './arrow.js';
import { takesColours } from './soft_body.js';

// Without a graphics card smooth edges and fine surfaces would cost most of the pictures.
function drawsBySoftware() {
  const gl = new OffscreenCanvas(1, 1).getContext('webgl2');
  const info = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class Renderer {
  constructor(canvas, sources) {
    this.software = drawsBySoftware();
    const gl = canvas.getContext('webgl2', { alpha: false, antialias: !this.software });
    if (!gl) throw new Error('this browser has no WebGL 2');
    this.canvas = canvas;
    this.gl = gl;
    this.programs = new Programs(gl, sources);
    for (const name of ['cavity', 'cover', 'metal', 'legend', 'arrow']) this.programs.prepare(name);
    this.block = gl.createBuffer();
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.block);
    gl.bufferData(gl.UNIFORM_BUFFER, blockBytes, gl.DYNAMIC_DRAW);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.block);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    this.arrow = new GpuMesh(gl).upload({ shape: 1, ...arrowMesh() });
    this.backdrop = new Backdrop(gl, this.programs);
    this.meshes = new Map();
    this.textures = new Textures(gl);
  }

  setScenery(scenery) {
    const { gl } = this;
    this.scenery = scenery;
    this.meshes.clear();
    this.backdrop.set(scenery.backdrop);
    for (const { finish } of scenery.backdrop) this.programs.prepare(finish);
    const tools = Math.min(scenery.tools.length, 8);
    for (const { finish, visual, marked } of scenery.bodies) {
      this.programs.prepare(finish, tools);
      if (marked) this.programs.prepare('marked');
      for (const part of visual?.parts ?? [])
        this.programs.prepare(part.finish, tools, part.textured ? 'TEXTURED' : '');
    }
    this.instruments = scenery.tools.map((tool) => tool.parts.map((part) =>
      new GpuMesh(gl).upload({ shape: 1, ...part, rest: part.position })));
  }

  resize(width, height) {
    const { canvas } = this.gl;
    if (canvas.width === width && canvas.height === height) return;
    canvas.width = width;
    canvas.height = height;
  }

  // The last picture is still being made: another one would only wait behind it.
  busy() {
    const { gl, fence } = this;
    if (!fence || gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) return Boolean(fence);
    gl.deleteSync(fence);
    this.fence = undefined;
    return false;
  }

  // `axes`: of the camera. `bodies`: SoftBody; `tools`: of the frame. `look`: {byScalar, legendMax, forceMax, through}.
  draw(axes, bodies, tools, look) {
    const { gl } = this, { width, height } = gl.canvas;
    this.axes = axes;
    const seen = tools.map((tool, i) => ({ tool, index: i, shape: this.scenery.tools[i], pose: tool.parts[0] }))
      .filter(({ tool, shape }) => tool.seen && shape);
    const words = sceneBlock(this.axes, width, height, seen, look.legendMax);
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.block);
    gl.bufferSubData(gl.UNIFORM_BUFFER, 0, words);
    gl.enable(gl.CULL_FACE);
    this.backdrop.prepare(words.subarray(16, 40), width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.backdrop.cover();
    for (const one of seen) this.drawInstrument(one);
    this.drawBodies(bodies, look, Math.min(seen.length, 8));
    for (const one of seen) this.drawArrow(one, look.forceMax);
    this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
  }

  drawBodies(bodies, look, tools) {
    const views = bodies.flatMap((body, b) =>
      body.views(this.scenery.mucosa_colour).map((view, i) => ({ view, key: `${b} ${i}` })));
    const clear = ({ view }) => look.through && (view.finish === 'duct' || view.finish === 'mucosa');
    const { gl } = this;
    for (const one of views) if (!clear(one)) this.drawSoft(one, look, tools);
    for (const one of views) if (one.view.marked) this.drawMarked(one);
    if (!look.through) return;
    gl.enable(gl.BLEND);
    gl.blendColor(0, 0, 0, 0.35);
    gl.blendFunc(gl.CONSTANT_ALPHA, gl.ONE_MINUS_CONSTANT_ALPHA);
    gl.depthMask(false);
    for (const one of views) if (clear(one)) this.drawSoft(one, look, tools);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  drawSoft({ view, key }, look, tools) {
    const { gl } = this, byScalar = look.byScalar && takesColours(view.finish);
    const variant = byScalar ? 'BY_SCALAR' : view.image ? 'TEXTURED' : '';
    const program = this.programs.get(byScalar ? 'tissue' : view.finish, tools, variant);
    if (!this.meshes.has(key)) this.meshes.set(key, new GpuMesh(gl));
    gl.useProgram(program.program);
    gl.uniform4f(program.colour, ...view.colour, 1);
    if (variant === 'TEXTURED') {
      this.textures.bind(view.texture);
      gl.uniform1i(program.image, 0);
    }
    this.meshes.get(key).upload(view).draw();
  }

  // Over the tissue that has just been drawn.
  drawMarked({ key }) {
    const { gl } = this;
    gl.useProgram(this.programs.get('marked').program);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(-1, -1);
    gl.depthMask(false);
    this.meshes.get(key).draw();
    gl.depthMask(true);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.disable(gl.BLEND);
  }

  drawInstrument({ tool, index, shape, pose }) {
    const { gl } = this, metal = this.programs.get('metal');
    gl.useProgram(metal.program);
    gl.uniform4f(metal.colour, shape.polish, 0, 0, shape.bare);
    gl.uniform4f(metal.shaft, ...axis(pose, 2), shape.shaft_radius);
    this.instruments[index].forEach((mesh, part) => {
      gl.uniformMatrix4fv(metal.placement, false, tool.parts[part]);
      mesh.draw();
    });
  }

  // The force on the tool, at its tip, over whatever is in front of it.
  drawArrow({ tool }, forceMax) {
    const { gl } = this, place = arrowPlace(origin(tool.parts[0]), tool.force, forceMax, this.axes.reach);
    if (!place) return;
    const arrow = this.programs.get('arrow');
    gl.useProgram(arrow.program);
    gl.uniformMatrix4fv(arrow.placement, false, place);
    gl.uniform1f(arrow.share, Math.hypot(...tool.force) / forceMax);
    gl.disable(gl.DEPTH_TEST);
    this.arrow.draw();
    gl.enable(gl.DEPTH_TEST);
  }

  // The colour scale as pixels, lowest first.
  scale(height) {
    const { gl } = this, target = gl.createFramebuffer(), colour = gl.createRenderbuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.bindRenderbuffer(gl.RENDERBUFFER, colour);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA8, 1, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, colour);
    gl.viewport(0, 0, 1, height);
    const legend = this.programs.get('legend');
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(legend.program);
    gl.uniform1f(legend.height, height);
    gl.bindVertexArray(null);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
    const pixels = new Uint8Array(4 * height);
    gl.readPixels(0, 0, 1, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    gl.deleteFramebuffer(target);
    gl.deleteRenderbuffer(colour);
    return pixels;
  }
}

