// SPDX-License-Identifier: AGPL-3.0-or-later
// The normal force of the last seconds: as the tissue relaxes, and as if it did not.
import { el } from '../dom.js';
import { colour, onThemeChange } from '../theme.js';
import * as units from '../units.js';

const SECONDS = 8;
const HEIGHT = 110;

export class ForceStrip {
  constructor() {
    this.canvas = el('canvas', { role: 'img', 'aria-label': 'Normal force of the last seconds' });
    this.element = el('div', { class: 'strip' }, this.canvas,
      el('div', { class: 'keys' },
        el('span', {}, el('i', { class: 'line' }), 'normal force'), el('span', {}, el('i', { class: 'line dashed' }), 'if elastic'),
        el('span', {}, `last ${SECONDS} s`)));
    this.points = [];
    onThemeChange(() => this.draw());
  }

  /** s; N. A time that goes back begins anew. */
  add(time, normal, elastic) {
    const last = this.points[this.points.length - 1];
    if (last && time <= last[0]) {
      if (time === last[0]) return;
      this.points = [];
    }
    this.points.push([time, normal, elastic]);
    while (this.points[0][0] < time - SECONDS) this.points.shift();
    this.draw();
  }

  draw() {
    const width = this.canvas.clientWidth, ratio = devicePixelRatio || 1;
    if (!width) return;
    this.canvas.width = width * ratio;
    this.canvas.height = HEIGHT * ratio;
    const context = this.canvas.getContext('2d');
    context.scale(ratio, ratio);
    const full = this.points.reduce((most, p) => Math.max(most, p[1], p[2]), 0);
    context.fillStyle = context.strokeStyle = colour('muted');
    context.font = '11px system-ui, sans-serif';
    context.fillText(full > 0 ? `to ${units.force(full)}` : 'normal force', 4, 11);
    context.globalAlpha = 0.5;
    context.strokeRect(0.5, 0.5, width - 1, HEIGHT - 1);
    context.globalAlpha = 1;
    if (!(full > 0)) return;
    const end = this.points[this.points.length - 1][0];
    const line = (row, name, dash) => {
      context.strokeStyle = colour(name);
      context.lineWidth = 1.8;
      context.setLineDash(dash);
      context.beginPath();
      this.points.forEach((p, i) => {
        const x = width - ((end - p[0]) / SECONDS) * width, y = HEIGHT - 4 - (p[row] / full) * (HEIGHT - 22);
        if (i) context.lineTo(x, y);
        else context.moveTo(x, y);
      });
      context.stroke();
    };
    line(2, 'muted', [4, 3]);
    line(1, 'series-3', []);
  }
}
