// The picture is drawn on a thread of its own: the mouse and the link do not wait where that takes long.
import { axesOf } from './scene_block.js';

const mostAhead = 100;  // frames

export class Picture {
  // `on`: what is called when the thread is ready, and of each picture when it has been drawn and when it is complete.
  constructor(canvas, sources, on) {
    if (!canvas.transferControlToOffscreen) throw new Error('this browser is too old: it cannot draw beside its page');
    this.canvas = canvas;
    this.ahead = 0;  // frames that the thread has been given since it drew last
    this.thread = new Worker('render_thread.js', { type: 'module' });
    this.thread.addEventListener('message', ({ data }) => {
      if (data.drawn) this.ahead = 0;
      for (const [what, of] of Object.entries(data)) on[what](of);
    });
    this.thread.addEventListener('error', (event) => on.failed(event.message ?? 'the page has no thread to draw on'));
    const surface = canvas.transferControlToOffscreen();
    this.thread.postMessage({ canvas: surface, sources }, [surface]);
  }

  // Scenery or topology, as it came.
  build(buffer) {
    this.ahead = 0;
    this.thread.postMessage(buffer);
  }

  // A frame, as it came. They do not pile up before a thread that draws no more.
  take(buffer) {
    if (++this.ahead <= mostAhead) this.thread.postMessage(buffer);
  }

  // What is seen from now on. `scale`: pixels of the picture in one of the page's; `look`: as Renderer's.
  show(camera, scale, look, paused) {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight]
      .map((length) => Math.max(Math.round(length * scale), 16));
    this.axes = axesOf(camera.fitted(width, height), width, height);
    const view = { width, height, axes: this.axes, look, paused }, said = JSON.stringify(view);
    if (said === this.said) return;
    this.said = said;
    this.thread.postMessage(view);
  }

  // As a PNG file.
  async file() {
    const image = await createImageBitmap(this.canvas), paper = new OffscreenCanvas(image.width, image.height);
    paper.getContext('2d').drawImage(image, 0, 0);
    return paper.convertToBlob({ type: 'image/png' });
  }
}
