// Buttons and keys.
import * as wire from './wire.js';

export function wireButtons(app) {
  const acts = {
    endoscope: () => app.camera.endoscope(), colour: () => app.toggle('colour'), through: () => app.toggle('through'),
    pause: () => app.toggle('pause'), grip: () => app.toggleJaws(), shot: () => app.save(),
    full: () => app.fullScreen(), give: () => app.link.send(wire.give(app.hand.tool)),
  };
  for (const button of document.querySelectorAll('[data-do]'))
    if (acts[button.dataset.do]) button.addEventListener('click', acts[button.dataset.do]);
  for (const button of document.querySelectorAll('[data-mode]'))
    button.addEventListener('click', () => app.setMode(button.dataset.mode));
  const pedal = document.querySelector('[data-do=pedal]');
  pedal.addEventListener('pointerdown', () => app.pedal(true));
  for (const type of ['pointerup', 'pointerleave']) pedal.addEventListener(type, () => app.pedal(false));
  document.getElementById('depth').addEventListener('input', (event) => app.setDepth(event.target.value));
  const list = document.querySelector('#tools select'), leave = () => document.getElementById('picture').focus();
  list.addEventListener('change', () => { app.selectTool(+list.value); leave(); });
  list.addEventListener('keydown', (event) => { if (event.key === 'Escape') leave(); });
}

// What a key does when it goes down, and some when it comes up.
export function keyTable(app) {
  const once = (act) => (down) => { if (down) act(); };
  const roll = (by) => Object.assign(once(() => app.hand.roll(by)), { repeats: true });
  return {
    1: once(() => app.setMode('press')), 2: once(() => app.setMode('move')), 3: once(() => app.setMode('look')),
    q: roll(-0.06), w: roll(0.06), g: once(() => app.toggleJaws()),
    ' ': (down) => app.pedal(down), e: once(() => app.camera.endoscope()),
    c: once(() => app.toggle('colour')), t: once(() => app.toggle('through')), p: once(() => app.toggle('pause')),
    s: once(() => app.save()), f: once(() => app.fullScreen()),
  };
}
