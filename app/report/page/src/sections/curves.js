// SPDX-License-Identifier: AGPL-3.0-or-later
// Curves of the shown nodes: what was computed as markers, what will be rendered as a line.
import { HOLE, RESPONSE } from '../data.js';
import { el, paragraph, table } from '../dom.js';
import { curvePlot, symbol } from '../plot.js';
import { lastKnot, responseForce, secantStiffness } from '../response.js';
import * as units from '../units.js';

const NORMAL = 0, LATERAL = 1;
const STEPS = 96;
const COMPUTED = 0, MEASURED = 1, ASSUMED = 2;
const ORIGIN = ['computed', 'measured', 'assumed'];
const COVERAGE = 2;  // standard uncertainties of a bar: 95 % of a normal distribution

const originOf = ({ measurement: m }, path) => m?.origin[path] ?? COMPUTED;

/** Whether lateral responses were made of the normal ones, for want of a measurement. */
export const hasAssumedPaths = ({ samples: s }) => s?.measurement?.origin.includes(ASSUMED) ?? false;

/** Sampled paths of a node, in the units of the axes: [{x, y, rendered}]; y of a drag counts from its start. */
function samples(data, vertex, kind, { length, force }) {
  const { samples: s } = data;
  const paths = [];
  for (let p = 0; p < s.vertex.length; ++p) {
    if (s.vertex[p] !== vertex || s.kind[p] !== kind) continue;
    const [from, to] = [s.offset[p], s.offset[p + 1]];
    const inUnits = (column) => Array.from(column.subarray(from, to), (f) => f * force.factor);
    const origin = originOf(s, p);
    paths.push({ x: Array.from(s.displacement.subarray(from, to), (d) => d * length.factor), y: inUnits(s.force), rendered: inUnits(s.rendered), origin,
      spread: origin === MEASURED ? inUnits(s.measurement.uncertainty).map((u) => COVERAGE * u) : undefined });
  }
  return paths;
}

/** m^3, change of the volume of the body when a node is pressed so deep; NaN beyond its last state. */
export function volumeChange({ samples: s }, vertex, depth) {
  for (let p = 0; p < s.vertex.length; ++p) {
    if (s.vertex[p] !== vertex || s.kind[p] !== NORMAL) continue;
    for (let i = s.offset[p] + 1; i < s.offset[p + 1]; ++i) {
      const [from, to] = [s.displacement[i - 1], s.displacement[i]];
      if (depth <= to * (1 + 1e-6)) return s.volume_change[i - 1] + ((depth - from) / (to - from)) * (s.volume_change[i] - s.volume_change[i - 1]);
    }
  }
  return NaN;
}

/** The response of a node as it is rendered, to its last knot; null without one. */
function rendered(columns, vertex, { length, force }) {
  const end = lastKnot(columns, vertex);
  if (!(end > 0)) return null;
  const x = Array.from({ length: STEPS + 1 }, (_, i) => (end * i) / STEPS);
  return { x: x.map((d) => d * length.factor), y: x.map((d) => responseForce(columns, vertex, d) * force.factor) };
}

/** What is rendered of a node: its normal response; along the travel of each of its drags at their depths, or, where a
 *  node has none and no depth matters, the lateral response. */
function lines(data, vertex, kind, axes) {
  const drags = kind === LATERAL ? samples(data, vertex, kind, axes).filter((path) => path.rendered.every(Number.isFinite)) : [];
  if (drags.length) return drags.map(({ x, rendered: y, origin }) => ({ x, y, dash: origin === ASSUMED ? [6, 4] : undefined }));
  if (kind === LATERAL && data.samples.coupled) return [];
  const line = rendered(kind === NORMAL ? data.normal : data.lateral, vertex, axes);
  const assumed = samples(data, vertex, kind, axes).some(({ origin }) => origin === ASSUMED);
  return line ? [{ ...line, dash: assumed ? [6, 4] : undefined }] : [];
}

function sets(data, shown, beside, kind, axes) {
  const out = [];
  for (const vertex of beside)
    for (const line of lines(data, vertex, kind, axes)) out.push({ label: `node ${vertex}, neighbour`, colour: 'muted', width: 1, ...line });
  for (const { vertex, colour } of shown) {
    for (const line of lines(data, vertex, kind, axes)) out.push({ label: `node ${vertex}, fitted`, colour, ...line });
    for (const { x, y, origin, spread } of samples(data, vertex, kind, axes)) out.push({ label: `node ${vertex}, ${ORIGIN[origin]}`, colour, markers: true, x, y, spread });
  }
  return out;
}

/** What the marks of measured curves mean; nothing of computed ones. */
function legendOf(data) {
  const { measurement: m } = data.samples;
  if (!m) return [];
  const known = m.uncertainty.some(Number.isFinite);
  return [
    paragraph(known ? 'Bars at measured samples: twice the standard uncertainty of the force to either side (95 %), with the scatter between repeats, baseline, contact point and load cell in it. The table has the same of the deepest force.'
      : 'The measured forces have no known uncertainty.', 'note measured'),
    hasAssumedPaths(data) ? paragraph('Lateral responses with dashed lines are assumed, not measured: the lateral stiffness is lateral_ratio of the sidecar times the normal one.', 'note assumed') : null,
  ].filter(Boolean);
}

/** Force at the deepest sample of a measured press, with its uncertainty; the scatter between repeats. */
function deepestOf({ samples: s }, vertex) {
  const p = s.vertex.findIndex((v, i) => v === vertex && s.kind[i] === NORMAL && originOf(s, i) === MEASURED);
  if (p < 0) return ['\u2013', '\u2013'];
  const last = s.offset[p + 1] - 1, u = s.measurement.uncertainty[last], scatter = s.measurement.scatter[last], repeats = s.measurement.repeats[p];
  return [`${units.force(s.force[last])} \u00b1 ${Number.isFinite(u) ? units.force(COVERAGE * u) : 'unknown'}`,
    Number.isFinite(scatter) ? `${units.force(scatter)} of ${units.count(repeats)}` : repeats > 1 ? 'unknown' : '\u2013'];
}

/** The nodes that share a triangle with one. */
export function neighboursOf({ surface }, vertex) {
  const found = new Set();
  for (let t = 0; t < surface.triangles.length; t += 3) {
    const corners = surface.triangles.subarray(t, t + 3);
    if (corners.includes(vertex)) corners.forEach((v) => found.add(v));
  }
  found.delete(vertex);
  return [...found];
}

export class Curves {
  constructor(data, nodes) {
    this.data = data;
    this.nodes = nodes;
    this.depth = data.key.depth;
    this.axes = { length: units.axis.length(data.key.depth), force: units.axis.force(data.key.max_force) };
    const { length, force } = this.axes;
    this.normal = curvePlot('Normal response: along the press direction', `Depth (${length.name})`, `Force (${force.name})`, 230);
    this.lateral = curvePlot(`Lateral response${hasAssumedPaths(data) ? ', assumed where dashed' : ''}: along each drag, from its start`, `Lateral deflection (${length.name})`, `Force (${force.name})`, 210);
    this.neighbours = false;
    this.legend = el('div', {});
    this.element = el('div', { id: 'curves' }, this.normal.element, el('div', { class: 'lateral' }, this.lateral.element), this.legend,
      paragraph(`Markers: states of the curves. Lines: the rendered response, of drags at the depths and azimuths of the curves. Upright dashes: the depth of the picture, to which the stiffness ${data.samples.measurement ? 'belongs' : 'and the change of the volume of the whole body belong'}.`, 'note'),
      ...legendOf(data), this.chooser());
    nodes.onChange(() => this.refresh());
    this.refresh();
  }

  setDepth(depth) {
    this.depth = depth;
    this.refresh();
  }

  refresh() {
    const shown = this.nodes.shown();
    const beside = this.neighbours && shown.length ? neighboursOf(this.data, shown[shown.length - 1].vertex) : [];
    this.normal.set(sets(this.data, shown, beside, NORMAL, this.axes), this.depth * this.axes.length.factor);
    this.lateral.set(sets(this.data, shown, beside, LATERAL, this.axes));
    this.legend.replaceChildren(this.table(shown));
  }

  table(shown) {
    const { vertices: v, samples: { measurement } } = this.data;
    const scatter = measurement?.scatter.some(Number.isFinite);  // else no site has repeats
    const error = (e, peak) => (Number.isFinite(e) && peak > 0 ? units.percent(e / peak) : '\u2013');
    const rows = shown.map((n) => {
      const swatch = el('span', { class: 'swatch' });
      swatch.style.background = `var(--${n.colour})`;
      const marker = el('span', { class: 'marker' }, symbol(n.colour));
      marker.style.color = `var(--${n.colour})`;
      const close = n.role === 'chosen'
        ? el('button', { class: 'plain', type: 'button', 'aria-label': `Remove node ${n.vertex}`, onclick: () => this.nodes.drop(n.vertex) }, '\u00d7') : null;
      const status = v.response_status[n.vertex];
      return [[swatch, marker, n.role, close], el('span', { id: n.role.split(',').map((r) => r.trim().replace(' ', '-'))[0] + '-node' }, String(n.vertex)),
        status === HOLE ? RESPONSE[status] : units.significant(secantStiffness(this.data.normal, n.vertex, this.depth)),
        error(v.normal_error[n.vertex], v.normal_peak[n.vertex]), error(v.lateral_error[n.vertex], v.lateral_peak[n.vertex]),
        ...(measurement ? deepestOf(this.data, n.vertex).slice(0, scatter ? 2 : 1) : [units.volume(volumeChange(this.data, n.vertex, this.depth))])];
    });
    const last = measurement ? ['Deepest force', ...(scatter ? ['Scatter'] : [])] : ['Volume change'];
    return table(['', 'Node', 'f(d)/d, N/m', 'Fit error normal', 'lateral', ...last], rows, [1, 2, 3, 4, 5, 6]);
  }

  chooser() {
    const input = el('input', { type: 'number', min: 0, max: this.nodes.size - 1, step: 1, 'aria-label': 'Node number' });
    const show = () => { if (input.value !== '') this.nodes.pick(Number(input.value)); };
    input.addEventListener('keydown', (e) => { if (e.key === 'Enter') show(); });
    return el('div', { class: 'controls' }, el('label', { class: 'screen' }, 'Show node', input, el('button', { type: 'button', onclick: show }, 'Show')),
      el('label', { class: 'screen', title: 'Responses of the nodes that share a triangle with the last node of the table, as thin lines' },
        el('input', { type: 'checkbox', id: 'neighbours', onchange: (e) => { this.neighbours = e.target.checked; this.refresh(); } }), 'neighbours'));
  }
}
