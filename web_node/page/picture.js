// The picture is drawn on a thread of its own: the mouse and the link do not wait where that takes long.
import { axesOf } from './scene_block.js';

const mostAhead = 100;  // frames

export class Picture {
  // `on`: what is called when the thread is ready, and of each picture when it has been drawn and when it is complete.
  constructor(canvas, sources, on) {
    if (!canvas.transferControlToOffscreen) throw new Error('this browser is too old: it cannot draw beside its page');
    this.canvas = canvas;
    this.ahead = 0;  // frames that the thread has been given since it drew last
    this.files = [];  // who waits for one
    this.thread = new Worker('render_thread.js', { type: 'module' });
    this.thread.addEventListener('message', ({ data }) => {
      if (data.drawn) this.ahead = 0;
      if ('file' in data) this.files.shift()(data.file);
      else for (const [what, of] of Object.entries(data)) on[what](of);
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
    const part = this.part(camera, scale);
    this.axes = part.axes;
    const view = { ...part, look, paused }, said = JSON.stringify(view);
    if (said === this.said) return;
    this.said = said;
    this.thread.postMessage(view);
  }

  part(camera, scale) {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight]
      .map((length) => Math.max(Math.round(length * scale), 16));
    return { width, height, axes: axesOf(camera.fitted(width, height), width, height) };
  }

  // The picture with all of the screen's pixels, as a PNG file; undefined before the first one.
  file(camera) {
    this.thread.postMessage({ file: this.part(camera, devicePixelRatio) });
    return new Promise((done) => { this.files.push(done); });
  }
}
