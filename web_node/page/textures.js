// Images that surfaces wear: each is decoded once, and shows a plain colour until it is.
const plain = new Uint8Array([138, 60, 47, 255]);

export class Textures {
  constructor(gl) {
    this.gl = gl;
    this.made = new Map();
  }

  // `png`: the bytes of the file, always the same array for the same image.
  bind(png) {
    const { gl, made } = this;
    if (!made.has(png)) made.set(png, this.make(png));
    gl.bindTexture(gl.TEXTURE_2D, made.get(png));
  }

  make(png) {
    const { gl } = this, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, plain);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    this.fill(texture, png);
    return texture;
  }

  async fill(texture, png) {
    const { gl } = this;
    const options = { premultiplyAlpha: 'none', colorSpaceConversion: 'none' };
    const image = await createImageBitmap(new Blob([png], { type: 'image/png' }), options);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, image);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  }
}
