// The page: what comes over the link is drawn, what the hand does goes back.
import { Curve, roundUp } from './curve.js';
import { Gamepad } from './gamepad.js';
import { Hand, areShut } from './hand.js';
import { Handling } from './handling.js';
import { Input } from './input.js';
import { Link } from './link.js';
import { Panel } from './panel.js';
import { Picture } from './picture.js';
import { Shapes } from './shapes.js';
import { ViewCamera } from './camera.js';
import { keyTable, wireButtons } from './controls.js';
import { size, sub } from './vec.js';
import * as wire from './wire.js';

const canvas = document.getElementById('picture');
const leastScales = { legendMax: 0.001, forceMax: 0.01 };  // [m], [N] of the last colour
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
    this.look = { byScalar: false, through: false, ...leastScales };
    this.given = [];  // frames that the picture has been given since the one that is shown
    this.mode = 'press';
    this.scale = Math.min(devicePixelRatio, 2);
    this.pictures = 0;
    this.link = new Link({
      open: () => this.panel.link('connected', true),
      close: () => this.lost(),
      refused: (why) => this.panel.refused(why),
      text: (message) => this.text(message),
      binary: (buffer) => this.binary(buffer),
    });
    this.hand = new Hand(this.link, () => this.bodies());
    this.gamepad = new Gamepad();
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
    this.panel.failed(words);
  }

  lost() {
    this.hand.rest();
    this.frame = this.next = this.topology = undefined;
    this.given = [];
    this.handling.end();
    this.panel.lost();
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

  // What was chosen stays where it is the same scene again.
  setScenery(scenery) {
    const chosen = this.scenery?.tools[this.hand.tool]?.name;
    this.scenery = scenery;
    this.topology = undefined;
    this.shapes?.setScenery(scenery);
    this.panel.setScenery(scenery);
    this.curve.clear();
    Object.assign(this.look, leastScales);
    if (JSON.stringify(this.camera.scene) !== JSON.stringify(scenery.camera)) this.setView(scenery);
    this.selectTool(Math.max(scenery.tools.findIndex(({ name }) => name === chosen), 0));
    this.showToggles();
  }

  setView({ camera, colour }) {
    this.camera.setScene(camera);
    this.look.byScalar = colour === 'displacement';
    this.setDepth(Math.min(Math.max(Math.round(30 * size(sub(camera.eye, camera.target))), 1), 15));
  }

  // The bodies as they are now, or as they are shown where their triangles are still to come.
  bodies() {
    const { shapes } = this;
    if (!shapes?.take(this.next)) shapes?.take(this.frame);
    return shapes?.bodies ?? [];
  }

  // With every picture of the display.
  everyPicture() {
    requestAnimationFrame(() => this.everyPicture());
    if (!this.scenery) return;
    const now = performance.now(), seconds = Math.min((now - (this.displayed ?? now)) / 1e3, 0.1);
    this.displayed = now;
    const early = this.software && !this.firstDrawn;  // fewer pixels are there sooner
    if (this.shapes)
      this.picture.show(this.camera, early ? 0.4 * this.scale : this.scale, this.look, Boolean(this.paused));
    if (this.frame) this.gamepad.read(this.hand, this.picture.axes, seconds, () => this.hand.take(this.next));
    if (!this.next || now - (this.worded ?? -wordsApart) < wordsApart) return;
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
    this.panel.drawn();
  }

  // What stands beside the picture, and goes on while that is frozen; nobody reads faster.
  words() {
    const tool = this.next.tools[this.hand.tool];
    this.panel.legend(this.look);
    this.panel.frame(this.next, this.me);
    if (tool) this.panel.tool(this.hand.shape, tool);
    this.panel.handling(this.handling);
    this.panel.hand(this.hand.holds(this.next, this.me) && performance.now() - this.hand.lateAt < lateSeen);
    this.curve.draw();
    const asked = this.hand.holds(this.next, this.me) && tool.asker;
    this.panel.ask(asked ? `Page ${asked} asks for the ${this.hand.shape.name}.` : undefined);
  }

  lead() {
    this.link.tellTaken();
    this.leadHand();
  }

  leadHand() {
    this.led = performance.now();
    if (!this.frame || document.hidden) return;
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
    if (!this.next || !this.hand.shape || this.mode === 'look') return false;
    if (this.mode === 'move') return this.hand.beginMove(this.next, this.picture.axes, at);
    return this.hand.beginPress(this.next, this.picture.axes, at);
  }

  dragTo(at, event) {
    if (this.picture.axes) this.hand.dragTo(this.next, this.picture.axes, at, event);
  }

  endDrag() {
    this.hand.endDrag(this.next);
  }

  deeper(by) {
    if (this.hand.drag?.kind === 'press') this.setDepth(1e3 * (this.hand.depth + by));
    else this.hand.deeper(by, this.picture.axes);
  }

  pan(right, up) {
    if (this.picture.axes) this.camera.pan(right, up, this.picture.axes.halfHeight);
  }

  setDepth(mm) {
    const slider = document.getElementById('depth'), bound = Math.min(Math.max(mm, slider.min), slider.max);
    slider.value = bound;
    slider.nextElementSibling.textContent = `${+bound.toFixed(1)} mm`;
    this.hand.depth = bound / 1e3;
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
    this.hand.shape = this.scenery.tools[index];
    document.querySelector('#tools select').value = index;
  }

  toggle(what) {
    if (what === 'colour') this.look.byScalar = !this.look.byScalar;
    if (what === 'through') this.look.through = !this.look.through;
    if (what === 'pause') this.paused = !this.paused;
    this.showToggles();
  }

  toggleJaws() {
    this.withTool('grips', () => this.hand.jaws(areShut(this.next.tools[this.hand.tool]) ? 1 : 0));
  }

  pedal(down) {
    if (down) this.withTool('cuts', () => this.hand.pedal(true));
    else this.hand.pedal(false);
  }

  showToggles() {
    const on = { colour: this.look.byScalar, through: this.look.through, pause: this.paused };
    for (const [name, value] of Object.entries(on))
      document.querySelector(`[data-do=${name}]`).classList.toggle('on', Boolean(value));
  }

  // `ability`: without which the tool is left alone.
  withTool(ability, act) {
    if (this.next && this.hand.shape?.[ability] && (this.hand.pose || this.hand.take(this.next))) act();
  }

  async save() {
    const file = await this.picture.file(this.camera), link = document.createElement('a');
    if (!file) return;
    link.download = `palpate-${new Date().toISOString().replace(/[:.]/g, '-')}.png`;
    link.href = URL.createObjectURL(file);
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
