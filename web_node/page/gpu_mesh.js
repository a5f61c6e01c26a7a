// A triangle mesh in buffers of its own.
const slots = { position: 3, normal: 3, rest: 3, scalar: 1, image: 2, marked: 1 };
const atRest = ['rest', 'image', 'marked'];

export class GpuMesh {
  constructor(gl) {
    this.gl = gl;
    this.array = gl.createVertexArray();
    this.buffers = new Map();
    this.shape = undefined;
  }

  // Everything, where `view.shape` is new; else what moves.
  upload(view) {
    const { gl } = this, fresh = this.shape !== view.shape;
    gl.bindVertexArray(this.array);
    for (const [slot, name] of Object.keys(slots).entries())
      if (view[name] && (fresh || !atRest.includes(name))) this.put(slot, name, view[name], fresh);
    if (fresh) {
      this.shape = view.shape;
      this.count = view.triangles.length;
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffer('index'));
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, view.triangles, gl.STATIC_DRAW);
    }
    return this;
  }

  put(slot, name, values, fresh) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer(name));
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    if (!fresh) return;
    gl.enableVertexAttribArray(slot);
    gl.vertexAttribPointer(slot, slots[name], gl.FLOAT, false, 0, 0);
  }

  buffer(name) {
    if (!this.buffers.has(name)) this.buffers.set(name, this.gl.createBuffer());
    return this.buffers.get(name);
  }

  draw() {
    this.gl.bindVertexArray(this.array);
    this.gl.drawElements(this.gl.TRIANGLES, this.count, this.gl.UNSIGNED_INT, 0);
  }
}
