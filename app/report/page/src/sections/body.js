// SPDX-License-Identifier: AGPL-3.0-or-later
// The body in three dimensions beside the curves of the chosen nodes.
import { BodyView } from '../body-view.js';
import { cssGradient, logTicks, roundTicks } from '../colormap.js';
import { firstRange, inRange, rangeOf, RANGES } from '../colour-range.js';
import { FIXED, HOLE, RESPONSE, SITE } from '../data.js';
import { el, paragraph, table } from '../dom.js';
import { downloadCanvas } from '../download.js';
import { Model } from '../model.js';
import { Outline } from '../outline.js';
import { secantStiffness, responseForce } from '../response.js';
import { colour } from '../theme.js';
import { errorOfVertices, errorsAt } from './comparison.js';
import { hasAssumedPaths } from './curves.js';
import { misfits, positionOf } from './fit.js';
import * as units from '../units.js';

/** The fields the picture can be coloured with: {label, unit, values(depth), sparse, from}. `sparse`:
 *  known at some nodes only; `from`: the value where the colours begin, if not the least. */
function fields(data) {
  const { vertices, certificate, surface } = data;
  const all = (f) => Float32Array.from({ length: vertices.response_status.length }, (_, v) => f(v));
  // A triangle beside a hole is a border for the force loop: it has no bound of its own.
  const open = (t) => surface.triangles.subarray(3 * t, 3 * t + 3).some((v) => vertices.response_status[v] === HOLE);
  const perTriangle = (column) =>
    Float32Array.from(surface.library_triangle, (m, t) => (m < 0 || open(t) ? NaN : column[m]));
  const list = {
    stiffness: { label: 'Secant stiffness f(d)/d', unit: 'N/m', deep: true,
      ofVertex: (d) => all((v) => secantStiffness(data.normal, v, d)) },
    lateral: { label: `Lateral secant stiffness${hasAssumedPaths(data) ? ', assumed where no drag was measured' : ''}`, unit: 'N/m', deep: true,
      ofVertex: (d) => all((v) => secantStiffness(data.lateral, v, d)) },
    fit: { label: 'Fit error, normal', unit: '% of peak force',
      ofVertex: () => all((v) => (100 * vertices.normal_error[v]) / vertices.normal_peak[v]) },
  };
  if (vertices.mesh_error.some(Number.isFinite)) {
    list.mesh = { label: 'Error of the mesh, normal, at most', unit: '% of peak force', from: 0,
      ofVertex: () => all((v) => (100 * vertices.mesh_error[v]) / vertices.normal_peak[v]) };
  }
  for (const kind of ['normal', 'lateral']) {
    if (!data.comparison?.curves.some((c) => c.kind === kind)) continue;
    list[`error_${kind}`] = { label: `Error against the reference, ${kind}`, unit: 'JND', sparse: true, from: 0,
      ofVertex: () => errorOfVertices(data, kind) };
  }
  if (certificate) {
    list.slip = { label: 'L_slip of each triangle', unit: 'N/m', ofTriangle: () => perTriangle(certificate.triangle_slip) };
    list.stick = { label: 'L_stick of each triangle', unit: 'N/m', ofTriangle: () => perTriangle(certificate.triangle_stick) };
  }
  return list;
}

/** Where a comparison is there, its errors are what the page was made for. */
const firstField = (options) => ['error_normal', 'error_lateral', 'stiffness'].find((name) => options[name]);

/** Caption of the range of the colours; a missing bound is not reported as a hole. */
function rangeText(field, depth, span, unbounded, colours) {
  const at = field.deep ? ` at d = ${units.length(depth)}` : '';
  const between = ({ low, high }) => `${units.significant(low)} to ${units.significant(high)} ${field.unit}`;
  const values = span ? between(span) : 'no value';
  const narrower = colours && (colours.low > span.low || colours.high < span.high)
    ? ` The colours end at ${between(colours)}.` : '';
  const grey = unbounded ? ` ${units.count(unbounded)} ${unbounded === 1 ? 'triangle has' : 'triangles have'} no bound (grey).` : '';
  return `${field.label}${at}: ${values}.${narrower}${grey}`;
}

/** What the picture shows of a field that is known at some nodes only. */
function sparseText(field, ofVertex, single) {
  if (!field.sparse) return '';
  const known = ofVertex.filter(Number.isFinite).length;
  const discs = single
    ? ` Discs: ${units.count(single)} ${single === 1 ? 'node' : 'nodes'} without compared neighbours, in the colour of the error; hover for the figures.` : '';
  return ` ${units.count(known)} of ${units.count(ofVertex.length)} nodes were compared.${discs} Grey: not compared.`;
}

export class ColourBar {
  constructor() {
    this.unit = el('div', { class: 'unit' });
    this.scale = el('div', { class: 'scale' });
    this.scale.style.background = cssGradient();
    this.element = el('div', { class: 'bar', 'aria-hidden': 'true' }, this.unit, this.scale);
  }

  set(label, unit, range) {
    this.unit.replaceChildren(label, el('br'), `(${unit})`);
    const { low, high, log } = range;
    this.scale.replaceChildren(...(log ? logTicks(low, high) : roundTicks(low, high)).map((value) => {
      const tick = el('span', { class: 'tick' }, units.significant(value, 4).replace(/\.0+$/, ''));
      tick.style.bottom = `${100 * inRange(range, value)}%`;
      return tick;
    }));
  }
}

const PARTIAL = 1, FAILED = 2;

/** Vertices with a symbol: where a site ended early, and where the fit misses it. */
function flags(v) {
  const early = Array.from(v.site_status, (status, vertex) => ({ vertex, status })).filter((n) => n.status === PARTIAL || n.status === FAILED);
  return [...early.map((n) => ({ vertex: n.vertex, symbol: 'cross' })),
    ...misfits(v).map((n) => ({ vertex: n.vertex, symbol: 'triangle' }))];
}

/** Stand where the stiffest node faces the viewer. */
function facing(data, model) {
  const v = data.chosen.stiffest;
  if (v < 0) return [1, -1, 0.4];
  const inward = data.vertices.inward.subarray(3 * v, 3 * v + 3);
  return Array.from(inward, (x) => -x);
}

const slider = (top, value, oninput) =>
  el('input', { type: 'range', min: 0.02, max: 1, step: 0.005, value: value / top, oninput, 'aria-label': 'Depth' });

export function bodySection(data, nodes, curves) {
  const model = new Model(data);
  const options = fields(data);
  const top = data.key.depth || 1e-3;
  let depth = top, name = firstField(options);
  const view = new BodyView(model, {
    facing: facing(data, model),
    onPick: (v) => nodes.pick(v),
    describe: (found) => describe(data, found, depth),
  });
  view.path = data.session?.drawn ?? null;
  view.flags = flags(data.vertices);
  view.inclusions = data.inclusions.map((inclusion) => new Outline(inclusion));
  const bar = new ColourBar();
  const depthText = el('output', {}), caption = el('p', { class: 'note', id: 'field-range' });
  let chosen = false;
  const choice = el('select', { id: 'colour-range', onchange: () => { chosen = true; refresh(); } },
    Object.entries(RANGES).map(([key, text]) => el('option', { value: key }, text)));
  const depthControl = el('label', {}, 'Depth d', slider(top, depth, (e) => { depth = top * e.target.value; refresh(); }), depthText);

  const refresh = () => {
    const field = options[name];
    const ofVertex = field.ofVertex?.(depth), ofTriangle = field.ofTriangle?.();
    const values = ofVertex ?? ofTriangle;
    const span = rangeOf(values, 'all');
    if (!chosen) choice.value = field.from === undefined ? firstRange(values) : 'all';
    const colours = rangeOf(values, choice.value);
    const range = colours ?? { low: 0, high: 1, log: false };
    if (field.from !== undefined && !range.log) range.low = Math.min(field.from, range.low);
    view.setField({ ofVertex, ofTriangle, ...range, sparse: field.sparse });
    bar.set(field.label, field.unit, range);
    depthText.textContent = units.length(depth);
    depthControl.style.display = field.deep ? '' : 'none';
    const unbounded = (ofTriangle ?? []).filter((bound) => bound === Infinity).length;
    caption.textContent = rangeText(field, depth, span, unbounded, colours) + sparseText(field, ofVertex, view.discs.length);
    curves.setDepth(depth);
  };
  nodes.onChange(() => {
    view.marked = nodes.shown().map((n) => ({ vertex: n.vertex, style: colour(n.colour) }));
    view.draw();
  });
  view.marked = nodes.shown().map((n) => ({ vertex: n.vertex, style: colour(n.colour) }));
  refresh();

  return el('section', { id: 'body' },
    el('h2', {}, 'The body'),
    paragraph('The colour shows a property of the responses on the boundary of the body. Drag to turn, click a node to see its curves.', 'lead'),
    el('div', { class: 'split' },
      el('div', {}, controls(options, name, view, depthControl, choice, (n) => { name = n; refresh(); }),
        el('div', { class: 'view' }, view.element, bar.element), caption, keys(data, model), endedEarly(data.vertices)),
      curves.element));
}

function controls(options, shown, view, depthControl, choice, choose) {
  const check = (label, key) => el('label', { class: 'screen' },
    el('input', { type: 'checkbox', checked: view.show[key], onchange: (e) => { view.show[key] = e.target.checked; view.draw(); } }), label);
  return el('div', { class: 'controls' },
    el('label', {}, 'Colour', el('select', { id: 'field', onchange: (e) => choose(e.target.value) },
      Object.entries(options).map(([key, f]) => el('option', { value: key, selected: key === shown }, f.label)))),
    el('label', { class: 'screen' }, 'Range', choice),
    depthControl,
    check('nodes', 'nodes'), view.flags.length ? check('marked sites', 'flags') : null, check('patches', 'borders'),
    view.path ? check('contact path', 'path') : null,
    view.inclusions.length ? check('inclusions', 'inclusions') : null,
    el('span', {},
      el('button', { type: 'button', 'aria-label': 'Zoom in', onclick: () => view.zoomBy(1.25) }, '+'), ' ',
      el('button', { type: 'button', 'aria-label': 'Zoom out', onclick: () => view.zoomBy(0.8) }, '\u2212'), ' ',
      el('button', { type: 'button', onclick: () => view.reset() }, 'Reset'), ' ',
      el('button', { type: 'button', onclick: () => downloadCanvas('body.png', view.canvas) }, 'PNG')));
}

/** Which sites ended early, where and why. */
function endedEarly(v) {
  const nodes = Object.keys(v.reasons).map(Number).filter((n) => v.site_status[n] === PARTIAL || v.site_status[n] === FAILED);
  if (!nodes.length) return null;
  const row = (n) => [String(n), SITE[v.site_status[n]], units.place(positionOf(v, n)), v.reasons[n], RESPONSE[v.response_status[n]]];
  return el('details', { id: 'ended-early' },
    el('summary', { class: 'warn' }, `${units.count(nodes.length)} ${nodes.length === 1 ? 'site' : 'sites'} ended early (crosses)`),
    table(['Node', 'Site', 'Position', 'Reason', 'Response'], nodes.map(row), [0]));
}

function keys(data, model) {
  const key = (name, text) => {
    const chip = el('i');
    chip.style.background = `var(--${name})`;
    return el('span', {}, chip, text);
  };
  const kinds = new Set(data.surface.facet_kind);
  return el('div', { class: 'keys' },
    kinds.has(FIXED) ? key('body-fixed', 'hatched: fixed by a support') : null,
    model.sprung.includes(1) ? el('span', {}, '\u2261 level lines: rests on springs') : null,
    kinds.has(1) ? key('body-hole', 'no response (a hole, a support or outside the press zones)') : null,
    flags(data.vertices).some((f) => f.symbol === 'cross') ? el('span', {}, '\u2715 site ended early') : null,
    flags(data.vertices).some((f) => f.symbol === 'triangle') ? el('span', {}, '\u25b3 fit misses the curves') : null,
    data.inclusions.length ? el('span', {}, `dashed line: outline of ${data.inclusions.map((i) => i.region).join(', ')}, inside the body`) : null,
    data.session?.drawn ? el('span', {}, 'white line: path of the contact point') : null);
}

/** Lines of the tip over the picture. */
function describe(data, { vertex, triangle, facet }, depth) {
  const { vertices, certificate, surface } = data;
  const lines = [`node ${vertex}`];
  const k = secantStiffness(data.normal, vertex, depth);
  if (Number.isFinite(k)) {
    lines.push(`f(d)/d = ${units.stiffness(k)}`, `f(${units.length(depth)}) = ${units.force(responseForce(data.normal, vertex, depth))}`);
  } else if (surface.facet_kind[facet] === FIXED) lines.push('fixed by a support');
  lines.push(`site ${SITE[vertices.site_status[vertex]]}; response ${RESPONSE[vertices.response_status[vertex]]}`);
  const m = surface.library_triangle[triangle];
  if (certificate && m >= 0) lines.push(`triangle ${m}: L_slip ${units.bound(certificate.triangle_slip[m])}`);
  lines.push(...errorsAt(data, vertex));
  const reason = vertices.reasons[vertex];
  if (reason) lines.push(reason);
  return lines;
}
