// The words beside the picture.
import { inks } from './curve.js';
import { areShut } from './hand.js';
import { markedColour } from './marked.js';
import { forceMark, forceReading, forceUnit } from './units.js';
import { size } from './vec.js';
import { SILENT } from './wire.js';

const flagWords = [[4, 'fault: force off'], [SILENT, 'let go: force fades'], [16, 'tissue late: force fades'],
  [256, 'tissue late: moves slowly'],
  [1, 'limited'], [32, 'damped']];
const byId = (id) => document.getElementById(id);

function row(tag, ...children) {
  const made = document.createElement(tag);
  made.append(...children);
  return made;
}

function dot(colour) {
  const made = row('i');
  made.style.background = colour;
  return made;
}

const pedalIsDown = (state) => state.pedal > 0.5;
const markedDot = () => dot(`rgb(${markedColour.map((c) => 255 * c).join()})`);
const strongest = (task) => forceReading(task.force_max_n, Math.max(task.force_max_n, 0.001));

export class Panel {
  said = [];  // by the nodes
  preparing = true;  // until the first picture is there
  connected = false;

  setScenery(scenery) {
    this.scenery = scenery;
    byId('title').textContent = scenery.title;
    document.title = `${scenery.title} - palpate`;
    byId('forces').replaceChildren(...scenery.tools.map((tool, i) =>
      row('li', dot(inks[i % inks.length]), tool.name, row('b'), row('small'))));
    document.querySelector('#tools select').replaceChildren(...scenery.tools.map((tool, i) => {
      const option = row('option', tool.name);
      option.value = i;
      return option;
    }));
    byId('tools').hidden = scenery.tools.length < 2;
    document.querySelector('[data-do=through]').hidden = !scenery.bodies.some((body) => body.finish === 'duct');
  }

  // What the chosen tool can do, and does.
  tool({ grips, cuts }, state) {
    this.button('grip', grips, areShut(state));
    this.button('pedal', cuts, pedalIsDown(state));
  }

  button(name, shown, on) {
    const button = document.querySelector(`[data-do=${name}]`);
    button.hidden = !shown;
    button.classList.toggle('on', on);
  }

  // `colours`: the pixels of the scale.
  scale(colours) {
    byId('legend').hidden = false;
    const canvas = document.querySelector('#legend canvas');
    const image = new ImageData(new Uint8ClampedArray(colours), canvas.width, 1);
    canvas.getContext('2d').putImageData(image, 0, 0);
  }

  // `look`: the arrows' force, and the tissue's displacement where it is coloured by it, of the last colour.
  legend({ forceMax, legendMax, byScalar }) {
    this.forceMax = forceMax;
    const scale = (mark, unit) => [0, 0.25, 0.5, 0.75, 1].map((share) => mark(share) + (share === 1 ? ` ${unit}` : ''));
    const newtons = scale((share) => forceMark(share * forceMax, forceMax), forceUnit(forceMax));
    const lengths = byScalar ? scale((share) => String(+(share * 1e3 * legendMax).toPrecision(3)), 'mm') : [];
    const said = [...newtons, ...lengths].join();
    if (this.scales === said) return;
    this.scales = said;
    byId('newtons').replaceChildren(...newtons.map((text) => row('li', text)));
    byId('lengths').replaceChildren(...lengths.map((text) => row('li', text)));
  }

  frame(frame, me) {
    this.elsewhere = frame.tools.some((tool) => !tool.offered && tool.flags & SILENT);
    frame.tools.forEach((tool, i) => {
      const item = byId('forces').children[i];
      if (!item) return;
      item.querySelector('b').textContent = tool.unheard ? '' : forceReading(size(tool.force), this.forceMax);
      const burns = this.scenery.tools[i].cuts && pedalIsDown(tool);
      const words = flagWords.filter(([bit]) => tool.flags & bit).map(([, text]) => text), burn = burns && 'cautery on';
      item.classList.toggle('burns', burns);
      item.classList.toggle('flag', tool.unheard || (tool.flags & (4 | 16 | SILENT)) !== 0);
      const hand = !tool.holder ? '' : tool.holder === me ? 'in your hand' : `in the hand of page ${tool.holder}`;
      const asked = tool.asker === me ? ['you have asked for it'] : [];
      const unheard = tool.unheard && 'not heard of: its force is not known';
      item.querySelector('small').textContent = [burn, hand, unheard, ...asked, ...words].filter(Boolean).join(', ');
    });
  }

  // What was told is no longer so.
  lost() {
    for (const item of byId('forces').children) {
      item.className = '';
      item.querySelector('b').textContent = item.querySelector('small').textContent = '';
    }
    this.tool({}, {});
    byId('handling').hidden = true;
    byId('rates').replaceChildren();
    this.ask(undefined);
    this.said = [];
    this.hand(false);
    this.link('no connection; trying again', false);
  }

  refused(why) {
    this.link(`${why}; trying again`, false);
  }

  status(status, page) {
    const rate = (node) => (node.silent ? 'silent' : `${node.rate_hz.toFixed(0)} Hz`);
    const rates = Object.fromEntries(status.nodes.map((node) => [node.role, rate(node)]));
    const lines = [['haptic loop', rates.haptic], ['tissue', rates.deform],
      ['frames sent', `${status.rate_hz.toFixed(0)} Hz`], ['pictures', `${page.rate.toFixed(0)} Hz`],
      ['tool to frame', status.latency_ms === null ? undefined : `${status.latency_ms.p50.toFixed(0)} ms`],
      ['hand to picture', page.delay === undefined ? undefined : `${page.delay.toFixed(0)} ms`],
      ['received', `${(page.bytes / 1e6).toFixed(2)} MB/s`], ['watching', status.viewers]];
    byId('rates').replaceChildren(...lines.filter(([, value]) => value !== undefined)
      .flatMap(([name, value]) => [row('dt', name), row('dd', String(value))]));
    // Of a tool that people may take its own line says so, and at once.
    const told = status.nodes.filter((node) => node.text && !(node.driver_silent && !this.elsewhere));
    this.said = [...status.said, ...told.map((node) => node.text)];
    this.note();
    this.tasks(status.tasks, status.resections);
  }

  // A tool in this page's hand has been let go within the last second.
  hand(late) {
    this.late = late;
    this.note();
  }

  drawn() {
    if (!this.preparing) return;
    this.preparing = false;
    this.note();
  }

  // The picture cannot be made.
  failed(words) {
    this.failure = words;
    this.note();
  }

  note() {
    const picture = this.failure ?? (this.connected && this.preparing && 'preparing the picture');
    const late = this.late && 'this page is too slow to hold the tool: it stands and its force fades';
    byId('note').textContent = [picture, late, ...this.said].filter(Boolean).join('; ');
  }

  handling({ seconds, path, strongest }) {
    const section = byId('handling');
    section.hidden = seconds === 0;
    const peak = forceReading(strongest, this.forceMax).replace(' ', '\u00a0');
    section.querySelector('p').textContent = `${seconds.toFixed(1)} s, path ${(1e3 * path).toFixed(0)} mm, peak ${peak}`;
  }

  tasks(tasks, resections) {
    const cut = (name, elements, volume) => row('p', ...name, `: ${(1e6 * volume).toFixed(2)} cm³ cut, ` +
      `${elements} element${elements === 1 ? '' : 's'}`);
    byId('tasks').replaceChildren(...resections.flatMap((of) => [
      row('h2', `Task: cut the marked part of ${of.body} off`),
      cut([markedDot(), 'Inside the marked part'], of.cut_inside, of.cut_inside_m3),
      cut(['Outside, which is to stay'], of.cut_outside, of.cut_outside_m3),
    ]), ...tasks.flatMap((task) => [
      row('h2', `Task: ${task.body}`),
      row('p', `${(1e3 * task.inserted_m).toFixed(0)} mm inserted, ${(1e3 * task.deepest_m).toFixed(0)} mm at the ` +
        `deepest in ${task.inserting_s.toFixed(1)} s, held for ${task.held_s.toFixed(1)} s`),
      row('p', `${task.wall_contacts} wall contacts, ${task.drops} drops, at most ${strongest(task)}`)]));
  }

  link(words, good) {
    byId('link').textContent = words;
    byId('link').classList.toggle('bad', !good);
    this.connected = good;
    this.note();
  }

  ask(name) {
    byId('ask').classList.toggle('on', name !== undefined);
    if (name !== undefined) document.querySelector('#ask span').textContent = name;
  }

  help(mode) {
    const starts = 'A scene starts when it is run, not with this page: run it again, and the page follows it.';
    const fingers = {
      press: 'Hold a finger on the organ to press it, drag to slide; let go and the tool lifts off. ' +
        'Two fingers turn and zoom.',
      move: 'A finger moves the tool across the view. Two fingers: together pushes it away, apart pulls it near, ' +
        'a twist rolls it.',
      look: 'A finger turns the camera, two zoom.',
    };
    if (matchMedia('(pointer: coarse)').matches) return void (byId('help').textContent = `${fingers[mode]} ${starts}`);
    const words = {
      press: 'Hold the button on the organ to press it, drag to slide, wheel for depth; let go and the tool lifts off.',
      move: 'Drag moves the tool across the view, wheel for depth, with Shift for roll; it stays where it is left.',
      look: 'Drag turns the camera.',
    };
    byId('help').textContent = `${words[mode]} Right button turns the camera, middle button pans, wheel zooms. ` +
      'Keys: 1 2 3 mode, Q W roll, G jaws, space pedal, E endoscope, C colour, T through, P pause, S save, ' +
      `F full screen. ${starts}`;
  }
}
