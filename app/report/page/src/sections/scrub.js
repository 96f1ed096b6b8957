// SPDX-License-Identifier: AGPL-3.0-or-later
// A recorded session in time: the tool on the body, where it was.
import { el, paragraph } from '../dom.js';
import { download } from '../download.js';
import { Model } from '../model.js';
import { toolOf } from '../tool-mesh.js';
import { TouchView } from '../touch-view.js';
import { times } from '../vectors.js';
import * as units from '../units.js';
import { secantField } from './secant-field.js';
import { inwardAt, row, SessionSkin } from './session-skin.js';

/** The direction of the tool in each step: that of the contact, in free motion that of the nearest contact in time. */
function axesOf(data) {
  const { drawn } = data.session;
  const ofElement = new Map(Array.from(data.surface.library_triangle, (m, t) => [m, t]));
  const axes = Array.from(drawn.element, (m, i) => (ofElement.has(m) && m >= 0 ? inwardAt(data, ofElement.get(m), row(drawn.contact, i)) : null));
  const known = axes.flatMap((axis, i) => (axis ? [i] : []));
  if (!known.length) return null;
  let next = 0;
  return axes.map((axis, i) => {
    while (next + 1 < known.length && Math.abs(drawn.time[known[next + 1]] - drawn.time[i]) <= Math.abs(drawn.time[known[next]] - drawn.time[i])) ++next;
    return axis ?? axes[known[next]];
  });
}

class Scrub {
  constructor(data, axes) {
    this.drawn = data.session.drawn;
    this.axes = axes;
    this.full = data.session.max_force || 1;
    this.end = this.drawn.time[this.drawn.time.length - 1];
    const first = Math.max(0, this.drawn.element.findIndex((m) => m >= 0));
    this.skin = new SessionSkin(data);
    this.view = new TouchView(new Model(data), { facing: times(-1, axes[first]), tool: toolOf(data), hand: null, skinOfPoint: this.skin.ofPoint });
    this.view.path = this.drawn;
    this.view.show.path = true;
    this.view.setField(secantField(data));
    this.view.canvas.setAttribute('aria-label', 'The tool on the body at a time of the session. Arrow keys turn the body.');
    this.text = el('output', { id: 'scrub-text' });
    this.slider = el('input', { type: 'range', id: 'scrub', min: 0, max: this.end, step: 'any', value: this.drawn.time[first], 'aria-label': 'Time of the session',
      oninput: (e) => this.show(Number(e.target.value)) });
    this.take = this.skin.skin && el('button', { type: 'button', id: 'scrub-obj', title: 'The skin at this time, in metres',
      onclick: () => download('skin.obj', 'model/obj', this.skin.obj(this.drawn, this.axes, this.stepAt(this.time))) }, 'Skin as OBJ');
    this.button = el('button', { type: 'button', id: 'scrub-play', onclick: () => this.toggle() }, 'Play');
    this.show(this.drawn.time[first]);
  }

  /** The last drawn step that is not later. */
  stepAt(time) {
    let [low, high] = [0, this.drawn.time.length - 1];
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (this.drawn.time[middle] <= time + 1e-9) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  show(time) {
    this.time = time;
    const i = this.stepAt(time);
    const { drawn } = this;
    const force = [drawn.fx[i], drawn.fy[i], drawn.fz[i]];
    const tip = row(drawn.position, i);
    const contact = drawn.element[i] >= 0;
    this.text.textContent = `${drawn.time[i].toFixed(3)}\u00a0s: ${contact ? `depth ${units.scaledLength(drawn.depth[i])}, ` : 'no contact, '}`
      + `force ${units.force(Math.hypot(...force))}, stored ${units.energy(drawn.energy[i])}`;
    const known = tip.every(Number.isFinite);
    this.view.place(known ? { tip, axis: this.axes[i], force, unit: this.full, skin: this.skin.at(drawn, this.axes, i) } : null);
  }

  toggle() {
    this.playing = !this.playing;
    this.button.textContent = this.playing ? 'Pause' : 'Play';
    if (!this.playing) return;
    if (this.time >= this.end) this.time = 0;
    let last = null;
    const frame = (now) => {
      if (!this.playing) return;
      const time = Math.min(this.end, this.time + (last === null ? 0 : (now - last) / 1000));
      last = now;
      this.slider.value = time;
      this.show(time);
      if (time < this.end) requestAnimationFrame(frame);
      else this.toggle();
    };
    requestAnimationFrame(frame);
  }
}

/** Null where the session never touched the body. */
export function scrubPanel(data) {
  const axes = axesOf(data);
  if (!axes) return null;
  const scrub = new Scrub(data, axes);
  return el('div', { class: 'scrub' },
    el('h3', {}, 'The tool in time'),
    el('div', { class: 'controls' }, scrub.button, scrub.slider, scrub.text, scrub.take),
    scrub.view.element,
    paragraph(`The tool to scale at the recorded positions, ${scrub.skin.skin ? 'the skin as the runtime blends it from the solved states' : 'its imprint on the undeformed skin'}, and the commanded force. White line: path of the contact point.`, 'note'));
}
