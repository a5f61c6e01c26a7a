// Force over time: the last seconds of every tool.
import { forceMark, forceUnit } from './units.js';

const seconds = 10, gap = 0.4;  // [s]; samples that are further apart are not joined
const least = 0.005;  // [N] of the scale
const overTop = 14;  // [px] room for words
export const inks = ['#ffb454', '#6fc3ff', '#9be564', '#ff7ab8', '#c9a6ff', '#5fe0c9', '#ffd866', '#ff8a65'];

export class Curve {
  constructor(canvas) {
    this.canvas = canvas;
    this.clear();
  }

  clear() {
    this.points = [];  // {t, forces} in order of t [s]
  }

  add(t, forces) {
    const last = this.points.at(-1);
    if (last && t < last.t - 1) this.clear();
    if (last && t <= last.t) return;
    this.points.push({ t, forces });
    let old = 0;
    while (this.points[old].t < t - seconds) ++old;
    this.points.splice(0, old);
  }

  draw() {
    const { canvas, points } = this, ratio = Math.min(devicePixelRatio, 2);
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const to = canvas.getContext('2d'), end = points.at(-1)?.t ?? 0;
    to.clearRect(0, 0, width, height);
    const top = roundUp(Math.max(least, ...points.map((p) => Math.max(...p.forces, 0))));
    const bottom = 0.96 * height, tall = bottom - overTop * ratio;
    const x = (t) => width * (1 - (end - t) / seconds), y = (f) => bottom - tall * f / top;
    this.grid(to, width, y, top, ratio);
    to.lineWidth = 1.6 * ratio;
    (points[0]?.forces ?? []).forEach((_, tool) => {
      to.strokeStyle = inks[tool % inks.length];
      to.beginPath();
      let before = -Infinity;
      for (const p of points) {
        if (p.t - before > gap) to.moveTo(x(p.t), y(p.forces[tool]));
        else to.lineTo(x(p.t), y(p.forces[tool]));
        before = p.t;
      }
      to.stroke();
    });
  }

  grid(to, width, y, top, ratio) {
    to.font = `${10 * ratio}px system-ui, sans-serif`;
    to.fillStyle = '#a29d95';
    to.strokeStyle = '#35312c';
    to.lineWidth = ratio;
    const word = (f) => y(f) - 3 * ratio;
    for (const f of [0, 0.5 * top, top]) {
      to.beginPath();
      to.moveTo(0, y(f));
      to.lineTo(width, y(f));
      to.stroke();
      to.fillText(`${forceMark(f, top)} ${forceUnit(top)}`, 4 * ratio, word(f));
    }
    to.textAlign = 'right';
    to.fillText(`last ${seconds} s`, width - 4 * ratio, word(top));
    to.textAlign = 'left';
  }
}

export function roundUp(value) {
  const decade = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 3, 4, 5, 6, 8].map((f) => f * decade).find((v) => v >= value * (1 - 1e-9)) ?? 10 * decade;
}
