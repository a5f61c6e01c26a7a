// What stands still: bones, lining and the wall of the cavity. Drawn once per camera, and copied into every frame.
import { GpuMesh } from './gpu_mesh.js';

const identity = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);

export class Backdrop {
  constructor(gl, programs) {
    this.gl = gl;
    this.programs = programs;
    this.target = gl.createFramebuffer();
    this.meshes = [];
  }

  set(meshes) {
    this.meshes = meshes.map((mesh) => ({
      ...mesh, gpu: new GpuMesh(this.gl).upload({ shape: 1, ...mesh, rest: mesh.position }),
    }));
    this.shown = undefined;
  }

  // `view`: the words of the frame that it depends on.
  prepare(view, width, height) {
    const now = view.map((word, i) => (i === 11 ? 0 : word));  // the legend's range does not matter here
    if (this.shown && this.shown.every((word, i) => word === now[i])) return;
    const { gl } = this;
    if (this.width !== width || this.height !== height) this.allocate(width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    for (const mesh of this.meshes) this.draw(mesh);
    gl.disable(gl.CULL_FACE);
    gl.useProgram(this.programs.get('cavity').program);
    gl.bindVertexArray(null);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.CULL_FACE);
    this.shown = now;
  }

  draw({ finish, colour, gpu }) {
    const { gl } = this, program = this.programs.get(finish);
    gl.useProgram(program.program);
    gl.uniform4f(program.colour, ...colour, 1);
    gl.uniformMatrix4fv(program.placement, false, identity);
    gpu.draw();
  }

  allocate(width, height) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    this.colours = this.texture(this.colours, gl.RGBA8, width, height, gl.COLOR_ATTACHMENT0);
    this.depths = this.texture(this.depths, gl.DEPTH_COMPONENT24, width, height, gl.DEPTH_ATTACHMENT);
    this.width = width;
    this.height = height;
  }

  texture(old, format, width, height, attachment) {
    const { gl } = this, texture = gl.createTexture();
    if (old) gl.deleteTexture(old);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, attachment, gl.TEXTURE_2D, texture, 0);
    return texture;
  }

  cover() {
    const { gl } = this, cover = this.programs.get('cover');
    gl.disable(gl.CULL_FACE);
    gl.depthFunc(gl.ALWAYS);
    gl.useProgram(cover.program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.colours);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.depths);
    gl.uniform1i(cover.colours, 0);
    gl.uniform1i(cover.depths, 1);
    gl.bindVertexArray(null);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.activeTexture(gl.TEXTURE0);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.CULL_FACE);
  }
}
