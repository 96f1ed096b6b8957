// SPDX-License-Identifier: AGPL-3.0-or-later
// Some quantities over the last seconds.
import { el } from '../dom.js';
import { colour, onThemeChange } from '../theme.js';

export const SECONDS = 10;
const HEIGHT = 120, TOP = 18, BOTTOM = 4;  // pixels

export class TimeStrip {
  /** lines: [{name, colour, dash}]; text: of the largest value in the strip. */
  constructor(title, lines, text) {
    this.title = title;
    this.lines = lines;
    this.text = text;
    this.canvas = el('canvas', { role: 'img', 'aria-label': `${title} of the last ${SECONDS} seconds` });
    this.element = el('div', { class: 'strip' }, this.canvas,
      el('div', { class: 'keys' }, lines.map(({ name, colour: of, dash }) => el('span', {}, el('i', { class: dash ? 'line dashed' : 'line', style: `border-top-color: var(--${of})` }), name)),
        el('span', {}, `last ${SECONDS} s`)));
    this.clear();
    onThemeChange(() => this.draw());
    new ResizeObserver(() => requestAnimationFrame(() => this.draw())).observe(this.canvas);
  }

  clear() { this.points = []; }

  /** time: s; values: one a line. A time that goes back begins anew. */
  add(time, values) {
    const last = this.points.at(-1);
    if (last && time === last[0]) return;
    if (last && time < last[0]) this.clear();
    this.points.push([time, ...values]);
  }

  /** The strip up to this time. */
  draw(end = this.points.at(-1)?.[0] ?? 0) {
    while (this.points.length && this.points[0][0] < end - SECONDS) this.points.shift();
    const width = this.canvas.clientWidth, ratio = devicePixelRatio || 1;
    if (!width) return;
    this.canvas.width = width * ratio;
    this.canvas.height = HEIGHT * ratio;
    const context = this.canvas.getContext('2d');
    context.scale(ratio, ratio);
    const values = this.points.flatMap((p) => p.slice(1));
    const high = Math.max(0, ...values), low = Math.min(0, ...values);
    context.fillStyle = context.strokeStyle = colour('muted');
    context.font = '11px system-ui, sans-serif';
    context.fillText(high > 0 ? `${this.title}, to ${this.text(high)}` : this.title, 4, 12);
    context.globalAlpha = 0.5;
    context.strokeRect(0.5, 0.5, width - 1, HEIGHT - 1);
    context.globalAlpha = 1;
    if (!(high > low)) return;
    const height = HEIGHT - TOP - BOTTOM;
    this.lines.forEach(({ colour: of, dash }, i) => {
      context.strokeStyle = colour(of);
      context.lineWidth = 1.8;
      context.setLineDash(dash ? [4, 3] : []);
      context.beginPath();
      this.points.forEach((p, n) => {
        const x = width - ((end - p[0]) / SECONDS) * width, y = TOP + height * (1 - (p[i + 1] - low) / (high - low));
        if (n) context.lineTo(x, y);
        else context.moveTo(x, y);
      });
      context.stroke();
    });
  }
}
