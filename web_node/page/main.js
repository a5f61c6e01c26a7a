// The page: what comes over the link is drawn, what the hand does goes back.
import { Curve, roundUp } from './curve.js';
import { Hand } from './hand.js';
import { Handling } from './handling.js';
import { Input } from './input.js';
import { Link } from './link.js';
import { Panel } from './panel.js';
import { Picture } from './picture.js';
import { Shapes } from './shapes.js';
import { ViewCamera } from './camera.js';
import { keyTable, wireButtons } from './controls.js';
import { readGamepad } from './gamepad.js';
import { size, sub } from './vec.js';
import * as wire from './wire.js';

const canvas = document.getElementById('picture');
const leadApart = 16, wordsApart = 50, lateSeen = 1000, mostGiven = 100;  // [ms]; frames

class App {
  constructor(sources) {
    this.picture = new Picture(canvas, sources, {
      ready: (thread) => this.ready(thread), drawn: (what) => this.drawn(what), made: () => this.made(),
      scale: (colours) => this.panel.scale(colours), failed: (words) => this.failed(words),
    });
    this.panel = new Panel();
    this.camera = new ViewCamera();
    this.curve = new Curve(document.getElementById('curve'));
    this.look = { byScalar: false, legendMax: 0.001, forceMax: 0.01, through: false };
    this.given = [];  // frames that the picture has been given since the one that is shown
    this.mode = 'press';
    this.scale = Math.min(devicePixelRatio, 2);
    this.pictures = 0;
    this.link = new Link({
      open: () => this.panel.link('connected', true),
      close: () => this.lost(),
      text: (message) => this.text(message),
      binary: (buffer) => this.binary(buffer),
    });
    this.hand = new Hand(this.link);
    this.handling = new Handling();
    this.keys = keyTable(this);
    this.input = new Input(canvas, this);
    wireButtons(this);
    this.setMode('press');
    setInterval(() => this.lead(), leadApart);  // the display's pictures may come more seldom
    addEventListener('pagehide', () => this.hand.release());
    document.addEventListener('visibilitychange', () => this.hand.pause());
    this.everyPicture();
  }

  // The thread that draws. `fineness`: of its bodies, which are those that a hand presses.
  ready({ software, fineness }) {
    this.software = software;
    this.shapes = new Shapes(fineness);
    if (this.scenery) this.shapes.setScenery(this.scenery);
    this.shapes.topology = this.topology;
  }

  failed(words) {
    document.getElementById('note').textContent = words;
  }

  lost() {
    this.hand.rest();
    this.frame = this.next = this.topology = undefined;
    this.given = [];
    this.panel.hand(false);
    this.panel.link('no connection; trying again', false);
  }

  text(message) {
    if (message.you !== undefined) this.me = message.you;
    if (message.status) this.status(message.status);
  }

  binary(buffer) {
    const kind = wire.kindOf(buffer);
    if (kind === wire.FRAME) return this.take(buffer);
    this.picture.build(buffer);
    if (kind === wire.SCENERY) this.setScenery(wire.decodeContainer(buffer));
    if (kind === wire.TOPOLOGY) this.setTopology(wire.decodeContainer(buffer));
  }

  take(buffer) {
    ++this.link.received;
    this.next = wire.decodeFrame(buffer);
    const forces = this.next.tools.map((tool) => size(tool.force)), strongest = Math.max(0, ...forces);
    this.curve.add(this.next.sense, forces);
    if (strongest > this.look.forceMax) this.look.forceMax = roundUp(strongest);
    this.handling.add(this.next, this.hand.tool, this.hand.holds(this.next, this.me));
    if (document.hidden) return;
    this.hand.watch(this.next, this.me);
    this.link.tellTaken();
    this.picture.take(buffer);
    this.given.push(this.next);
    if (this.given.length > mostGiven) this.given.shift();
  }

  setTopology(topology) {
    this.topology = topology;
    if (this.shapes) this.shapes.topology = topology;
  }

  setScenery(scenery) {
    this.scenery = scenery;
    this.topology = undefined;
    this.shapes?.setScenery(scenery);
    this.panel.setScenery(scenery);
    const back = this.camera.scene;
    if (JSON.stringify(back) !== JSON.stringify(scenery.camera)) this.camera.setScene(scenery.camera);
    this.look.byScalar = scenery.colour === 'displacement';
    this.selectTool(0);
    this.setDepth(Math.min(Math.max(Math.round(30 * size(sub(scenery.camera.eye, scenery.camera.target))), 1), 15));
    this.showToggles();
  }

  // The bodies as they are shown: a press begins on them.
  bodies() {
    const { shapes } = this;
    if (!shapes?.take(this.frame)) shapes?.take(this.next);
    return shapes?.bodies ?? [];
  }

  // With every picture of the display.
  everyPicture() {
    requestAnimationFrame(() => this.everyPicture());
    if (!this.shapes || !this.scenery) return;
    const now = performance.now(), seconds = Math.min((now - (this.displayed ?? now)) / 1e3, 0.1);
    this.displayed = now;
    const early = this.software && !this.firstDrawn;  // fewer pixels are there sooner
    this.picture.show(this.camera, early ? 0.4 * this.scale : this.scale, this.look, Boolean(this.paused));
    if (!this.frame) return;
    readGamepad(this.hand, this.picture.axes, seconds, () => this.hand.take(this.frame));
    if (!this.firstDrawn || now - (this.worded ?? -wordsApart) < wordsApart) return;
    this.worded = now;
    this.words();
  }

  // `seconds`: since the picture before it was begun. `most`: the largest displacement in it [m].
  drawn({ number, seconds, most }) {
    if (performance.now() - this.led > 2 * leadApart) this.leadHand();  // where pictures wait, they come before timers
    const at = this.given.findIndex((frame) => frame.number === number);
    if (at >= 0) [this.frame] = this.given.splice(0, at + 1).slice(-1);
    if (!this.frame) return;
    if (most > this.look.legendMax) this.look.legendMax = roundUp(most);
    this.hand.drawn(this.frame, this.me);
    this.adapt(Math.min(seconds, 0.1));
    ++this.pictures;
  }

  made() {
    this.firstDrawn ??= performance.now();
  }

  // What stands beside the picture; nobody reads faster.
  words() {
    if (!this.frame) return;
    this.panel.legend(this.look);
    this.panel.frame(this.frame, this.me);
    this.panel.handling(this.handling);
    this.panel.hand(this.hand.holds(this.next, this.me) && performance.now() - this.hand.lateAt < lateSeen);
    this.curve.draw();
    this.askOrGive();
  }

  lead() {
    this.link.tellTaken();
    this.leadHand();
  }

  leadHand() {
    this.led = performance.now();
    if (!this.frame || document.hidden) return;
    this.hand.shape = this.scenery.tools[this.hand.tool];
    this.hand.agree(this.next, this.me);
    this.hand.follow(this.next);
  }

  // Fewer pixels where the machine does not keep up: pictures that wait for one another make the hand late too.
  adapt(seconds) {
    const full = Math.min(devicePixelRatio, 2);
    this.slow = (this.slow ?? 0) + (seconds > 0.02 ? Math.min(50 * seconds, 4) : -0.5);
    if (this.slow > 12 && this.scale > 0.5) this.scale = Math.max(0.5, 0.75 * this.scale);
    if (this.slow < -400 && this.scale < full) this.scale = Math.min(full, 1.2 * this.scale);
    if (this.slow > 12 || this.slow < -400) this.slow = 0;
  }

  askOrGive() {
    const tool = this.frame.tools[this.hand.tool];
    const asked = tool && this.hand.holds(this.frame, this.me) && tool.asker;
    this.panel.ask(asked ? `Page ${tool.asker} asks for the ${this.scenery.tools[this.hand.tool].name}.` : undefined);
  }

  status(status) {
    const now = performance.now(), since = (now - (this.statusAt ?? now)) / 1e3;
    if (since > 0) {
      const delays = this.hand.delays.slice(-60).sort((a, b) => a - b);
      this.panel.status(status, {
        rate: this.pictures / since, bytes: this.link.bytes / since, delay: delays[Math.floor(delays.length / 2)],
      });
    }
    this.statusAt = now;
    this.pictures = 0;
    this.link.bytes = 0;
  }

  beginDrag(at) {
    if (!this.frame || this.mode === 'look') return false;
    if (this.mode === 'move') return this.hand.beginMove(this.frame, this.picture.axes, at);
    return this.hand.beginPress(this.frame, this.bodies(), this.picture.axes, at);
  }

  dragTo(at, event) {
    if (this.picture.axes) this.hand.dragTo(this.next, this.picture.axes, at, event);
  }

  endDrag() {
    this.hand.endDrag();
  }

  deeper(by) {
    this.hand.deeper(by, this.picture.axes);
    if (this.hand.drag?.kind === 'press') this.setDepth(1e3 * this.hand.depth);
  }

  pan(right, up) {
    if (this.picture.axes) this.camera.pan(right, up, this.picture.axes.halfHeight);
  }

  setDepth(mm) {
    const slider = document.getElementById('depth');
    slider.value = mm;
    slider.nextElementSibling.textContent = `${+Number(mm).toFixed(1)} mm`;
    this.hand.depth = mm / 1e3;
  }

  setMode(mode) {
    this.mode = mode;
    for (const button of document.querySelectorAll('[data-mode]'))
      button.classList.toggle('on', button.dataset.mode === mode);
    this.panel.help(mode);
  }

  selectTool(index) {
    if (index !== this.hand.tool) this.hand.release();
    this.hand.tool = index;
    document.querySelector('#tools select').value = index;
  }

  toggle(what) {
    if (what === 'colour') this.look.byScalar = !this.look.byScalar;
    if (what === 'through') this.look.through = !this.look.through;
    if (what === 'pause') this.paused = !this.paused;
    if (what === 'grip') this.closed = !this.closed;
    if (what === 'grip') this.withTool(() => this.hand.jaws(this.closed));
    this.showToggles();
  }

  showToggles() {
    const on = { colour: this.look.byScalar, through: this.look.through, pause: this.paused, grip: this.closed };
    for (const [name, value] of Object.entries(on))
      document.querySelector(`[data-do=${name}]`).classList.toggle('on', Boolean(value));
  }

  withTool(act) {
    if (this.frame && (this.hand.pose || this.hand.take(this.frame))) act();
  }

  async save() {
    const link = document.createElement('a');
    link.download = `palpate-${new Date().toISOString().replace(/[:.]/g, '-')}.png`;
    link.href = URL.createObjectURL(await this.picture.file());
    link.click();
    URL.revokeObjectURL(link.href);
  }

  // The page as it is, with its buttons.
  fullScreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else document.documentElement.requestFullscreen?.();
  }
}

try {
  const answer = await fetch('shaders.json');
  globalThis.palpate = new App(await answer.json());
} catch (error) {
  document.getElementById('note').textContent = error.message;
  throw error;
}
