// The thread that draws: it takes what came over the link as it came, and the page's view, and draws the newest of both.
import { Renderer } from './renderer.js';
import { Shapes } from './shapes.js';
import * as wire from './wire.js';

const picturesApart = 12, softwareFineness = 0.25, mostFine = 4096;  // [ms]; [pixel]

class RenderThread {
  constructor({ canvas, sources }) {
    this.renderer = new Renderer(canvas, sources);
    this.fineness = this.renderer.software ? softwareFineness : 1;
    this.shapes = new Shapes(this.fineness);
    this.last = -Infinity;  // when a picture was begun [ms]
    postMessage({ ready: { software: this.renderer.software, fineness: this.fineness } });
  }

  take(data) {
    if (data.file) return void this.file(data.file);
    if (data instanceof ArrayBuffer) this.binary(data);
    else this.view = data;
    this.changed = true;
    this.drawIn(0);  // once what else has come is taken: the newest is drawn
  }

  binary(buffer) {
    const kind = wire.kindOf(buffer);
    if (kind === wire.SCENERY) this.setScenery(wire.decodeContainer(buffer));
    if (kind === wire.TOPOLOGY) this.shapes.topology = wire.decodeContainer(buffer);
    if (kind === wire.FRAME) this.next = wire.decodeFrame(buffer);
  }

  setScenery(scenery) {
    this.renderer.setScenery(scenery);
    this.shapes.setScenery(scenery);
    this.next = this.frame = undefined;
  }

  // [ms]
  drawIn(wait) {
    this.again ??= setTimeout(() => { this.again = undefined; this.draw(); }, wait);
  }

  draw() {
    if (this.renderer.busy()) return this.drawIn(4);
    this.tellMade();
    if (!this.changed || !this.view) return;
    const now = performance.now(), since = now - this.last;
    if (since < picturesApart) return this.drawIn(picturesApart - since);
    if (!(this.view.paused && this.frame) && this.shapes.take(this.next)) this.frame = this.next;
    if (!this.frame) return;
    this.changed = false;
    this.last = now;
    const { width, height, axes, look } = this.view;
    this.renderer.resize(width, height);
    this.renderer.draw(axes, this.shapes.bodies, this.frame.tools, look);
    this.making = true;
    postMessage({ drawn: { number: this.frame.number, seconds: since / 1e3, most: this.shapes.most } });
    this.drawIn(4);  // until it is complete
  }

  // The picture once more, by itself: with smooth edges whatever the machine, since it is made finer than it is kept.
  async file({ width, height, axes }) {
    if (!this.frame) return postMessage({ file: undefined });
    if (this.renderer.busy()) return setTimeout(() => this.file({ width, height, axes }), 4);
    const finer = Math.max(width, height) > mostFine ? 1 : 2, paper = new OffscreenCanvas(width, height);
    this.renderer.resize(finer * width, finer * height);
    this.renderer.draw(axes, this.shapes.bodies, this.frame.tools, this.view.look);
    paper.getContext('2d').drawImage(this.renderer.canvas, 0, 0, width, height);
    this.changed = true;  // the next one has its own size again
    this.drawIn(0);
    postMessage({ file: await paper.convertToBlob({ type: 'image/png' }) });
  }

  tellMade() {
    if (!this.making) return;
    this.making = false;
    postMessage({ made: true });
    if (!this.scaled) postMessage({ scale: this.renderer.scale(128) });  // after the first picture: it takes a while
    this.scaled = true;
  }
}

let thread;
addEventListener('message', ({ data }) => {
  try {
    if (thread) thread.take(data);
    else thread = new RenderThread(data);
  } catch (error) {
    postMessage({ failed: error.message });
    throw error;
  }
});
