// A picture made beside the page and carried into it when it is complete. Without a graphics card the browser waits for
// a WebGL canvas of the page to be drawn before the page goes on, and with the page its hand would stand.
export class Carried {
  // `gl`: of a canvas that is not in the page. `canvas`: in the page.
  constructor(gl, canvas) {
    this.gl = gl;
    this.canvas = canvas;
    this.paper = canvas.getContext('2d', { alpha: false, willReadFrequently: true });
    this.pack = gl.createBuffer();
  }

  // What has been drawn is copied once it is complete.
  send(width, height) {
    const { gl } = this;
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.pack);
    if (this.image?.width !== width || this.image?.height !== height) {
      this.image = new ImageData(width, height);
      this.pixels = new Uint8Array(4 * width * height);
      gl.bufferData(gl.PIXEL_PACK_BUFFER, this.pixels.length, gl.STREAM_READ);
    }
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, 0);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
  }

  // The copy is there, its lowest line first.
  arrive() {
    const { gl, canvas, image, pixels } = this, line = 4 * image.width;
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.pack);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, pixels);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    for (let at = 0, from = pixels.length - line; from >= 0; at += line, from -= line)
      image.data.set(pixels.subarray(from, from + line), at);
    resize(canvas, image.width, image.height);
    this.paper.putImageData(image, 0, 0);
  }
}

export function resize(canvas, width, height) {
  if (canvas.width === width && canvas.height === height) return;
  canvas.width = width;
  canvas.height = height;
}
