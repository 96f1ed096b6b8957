// SPDX-License-Identifier: AGPL-3.0-or-later
// A session while it runs: its tool on the body, the skin, the force and the energies, as the server of the page sends them.
import { definitions, el, paragraph } from '../dom.js';
import { downloadCanvas } from '../download.js';
import { Model } from '../model.js';
import { Outline } from '../outline.js';
import { responseForce } from '../response.js';
import * as status from '../runtime.js';
import { toolOf } from '../tool-mesh.js';
import { TouchView } from '../touch-view.js';
import { dot, minus, times } from '../vectors.js';
import * as units from '../units.js';
import { FrictionCone } from './friction-cone.js';
import { inwardAt, row, SessionSkin } from './session-skin.js';
import { secantField } from './secant-field.js';
import { TimeStrip } from './time-strip.js';

const SILENCE = 1500;  // ms without a frame, after which a running session is said to be silent

export function liveHeader(data) {
  const { key } = data;
  return el('header', {},
    el('h1', {}, data.title),
    paragraph('A session as it runs, from its journal: the page cannot touch it.', 'lead'),
    definitions([
      ['Session', el('output', { id: 'live-session' }, 'none yet')],
      ['Tool', `${key.tool_shape}, radius ${units.length(key.tool_radius)}`]], 'facts'));
}

const WORDS = [[status.BEYOND_DEPTH, 'beyond the deepest sample: extrapolated'], [status.AT_BORDER, 'at a border'],
  [status.ENERGY_LIMITED, 'limited by the energy rule'], [status.FORCE_LIMITED, 'slide rate-limited'], [status.SLIDING, 'sliding']];
const stateText = ({ element, status: bits }) => (element < 0 ? 'no contact' : WORDS.find(([bit]) => bits & bit)?.[1] ?? 'in contact, sticking');

class Readings {
  constructor() {
    const names = [['state', 'State'], ['time', 'Time'], ['depth', 'Depth'], ['normal', 'Normal force'], ['lateral', 'Lateral force'], ['largest', 'Largest force'],
      ['energy', 'Stored energy'], ['tank', 'Energy tank'], ['absorbed', 'Absorbed'], ['margin', 'Least absorbed \u2212 (stored + tank)'],
      ['steps', 'Steps'], ['late', 'Late steps'], ['clamped', 'Clamped steps'], ['beyond', 'Steps beyond the depth']];
    this.outputs = Object.fromEntries(names.map(([key]) => [key, el('output', { id: `live-${key}` })]));
    this.place = el('div', {});
    this.element = el('div', {},
      el('dl', { class: 'facts' }, names.flatMap(([key, name]) => [el('dt', {}, name), el('dd', {}, this.outputs[key])])), this.place);
  }

  begin(friction) {
    this.cone = new FrictionCone(friction);
    this.place.replaceChildren(this.cone.element);
  }

  show({ last, counts }, axis) {
    const put = (key, text) => { this.outputs[key].textContent = text; };
    const onBody = times(-1, last.force);
    const normal = last.element < 0 ? 0 : dot(onBody, axis);
    const lateral = last.element < 0 ? 0 : Math.hypot(...minus(onBody, times(normal, axis)));
    put('state', stateText(last));
    put('time', `${last.time.toFixed(2)}\u00a0s`);
    put('depth', units.scaledLength(last.element < 0 ? 0 : last.depth));
    put('normal', units.force(normal));
    put('lateral', units.force(lateral));
    put('largest', units.force(counts.largest_force));
    for (const key of ['energy', 'tank', 'absorbed']) put(key, units.energy(last[key]));
    const passive = counts.least_margin >= -1e-12;
    put('margin', passive ? 'never below zero: passive' : `${units.energy(counts.least_margin)}: violated`);
    this.outputs.margin.className = passive ? '' : 'warn';
    put('steps', `${units.count(counts.steps)}, ${units.count(counts.contact)} in contact`);
    for (const [key, of] of [['late', 'late'], ['clamped', 'clamped'], ['beyond', 'beyond_depth']]) put(key, units.count(counts[of]));
    this.cone.show(normal, lateral);
  }
}

class Live {
  constructor(data) {
    this.data = data;
    this.elements = new Map(Array.from(data.surface.library_triangle, (m, t) => [m, t]));
    this.skin = new SessionSkin(data);
    const start = Math.max(0, data.chosen.stiffest);
    this.axis = row(data.vertices.inward, start);
    this.view = new TouchView(new Model(data), { facing: times(-1, this.axis), tool: toolOf(data), hand: null, skinOfPoint: this.skin.ofPoint });
    this.view.inclusions = data.inclusions.map((inclusion) => new Outline(inclusion));
    this.view.setField(secantField(data));
    this.view.canvas.setAttribute('aria-label', 'The tool on the body as it is now. Arrow keys turn the body.');
    const largest = responseForce(data.normal, start, data.key.deepest);
    this.unit = largest > 0 ? largest : 1;
    this.readings = new Readings();
    this.forces = new TimeStrip('Force', [{ name: 'force', colour: 'series-3' }], units.force);
    this.energies = new TimeStrip('Energy', [{ name: 'absorbed', colour: 'series-5' }, { name: 'stored', colour: 'series-1' }, { name: 'tank', colour: 'series-2', dash: true }], units.energy);
    this.session = 0;
  }

  /** A frame of the server; the picture follows at the next frame of the browser. */
  take(frame) {
    this.heard = performance.now();
    if (frame.session !== this.session) this.begin(frame);
    const { recent } = frame;
    recent.time.forEach((time, i) => {
      this.forces.add(time, [recent.force[i]]);
      this.energies.add(time, [recent.absorbed[i], recent.energy[i], recent.tank[i]]);
    });
    this.frame = frame;
    this.tell();
    if (!this.pending) this.pending = requestAnimationFrame(() => this.show());
  }

  begin(frame) {
    this.session = frame.session;
    this.forces.clear();
    this.energies.clear();
    if (frame.session > 0) this.readings.begin(frame.friction);
  }

  /** What is known of the session, in words. */
  tell() {
    const { frame } = this;
    const place = document.getElementById('live-session');
    if (!place) return;
    const silent = performance.now() - this.heard > SILENCE;
    const state = this.lost ? 'palpate watch has ended' : !frame?.session ? 'waiting for one to begin' : !frame.running ? 'ended' : silent ? 'silent: the loop makes no steps, or has been killed' : 'running';
    const about = frame?.session ? `${frame.device || 'unnamed device'}${frame.rate > 0 ? `, ${units.frequency(frame.rate)}` : ''}, \u03bc = ${units.significant(frame.friction)}: ` : '';
    const other = frame?.session && !frame.same_library ? '; it is of another library than the one drawn here' : '';
    place.textContent = about + state + other;
    place.className = other || this.lost ? 'warn' : '';
  }

  axisOf({ element, contact }) {
    if (element >= 0 && this.elements.has(element)) this.axis = inwardAt(this.data, this.elements.get(element), contact);
    return this.axis;
  }

  show() {
    this.pending = 0;
    const { last } = this.frame;
    if (!last) return;
    const axis = this.axisOf(last);
    this.readings.show(this.frame, axis);
    this.forces.draw(last.time);
    this.energies.draw(last.time);
    const columns = { contact: Float64Array.from(last.contact), position: Float64Array.from(last.position), element: [last.element] };
    const known = last.position.every(Number.isFinite) && this.frame.same_library;
    this.view.place(known ? { tip: last.position, axis, force: last.force, unit: this.unit, skin: this.skin.at(columns, [axis], 0) } : null);
    this.onShow?.();
  }
}

export function liveSection(data) {
  const live = new Live(data);
  const skin = live.skin.skin ? 'the skin as the runtime blends it from the solved states' : 'its imprint on the undeformed skin';
  const element = el('section', { id: 'live' }, el('h2', {}, 'Now'),
    el('div', { class: 'controls' },
      el('button', { type: 'button', 'aria-label': 'Zoom in', onclick: () => live.view.zoomBy(1.25) }, '+'),
      el('button', { type: 'button', 'aria-label': 'Zoom out', onclick: () => live.view.zoomBy(0.8) }, '\u2212'),
      el('button', { type: 'button', onclick: () => downloadCanvas('live.png', live.view.canvas) }, 'PNG')),
    el('div', { class: 'split' },
      el('div', {}, live.view.element,
        el('p', { class: 'note' }, `The tool to scale, ${skin}, and the commanded force. Drag to turn the body. What is shown is at most some 30 times a second; the journal has every step.`),
        live.forces.element),
      el('div', {}, live.readings.element, live.energies.element)));
  live.onShow = () => { element.dataset.shown = String(Number(element.dataset.shown ?? 0) + 1); };
  const source = new EventSource('/steps');
  source.onmessage = (event) => {
    live.lost = false;
    live.take(JSON.parse(event.data));
  };
  source.onerror = () => {
    live.lost = true;
    live.tell();
  };
  setInterval(() => live.tell(), 500);
  return element;
}
