// SPDX-License-Identifier: AGPL-3.0-or-later
// A body before anything is computed on it: supports, press zones, sites, and what repair moved.
import { BodyView } from '../body-view.js';
import { FIXED, HOLE, TOUCHABLE } from '../data.js';
import { definitions, el, paragraph } from '../dom.js';
import { Model } from '../model.js';
import { Outline } from '../outline.js';
import { ColourBar } from './body.js';
import { largest } from './repair.js';
import * as units from '../units.js';

const MM = 1e3;
const LEAST = 0.01;   // of the scale; what moved less is grey, so that its shape is seen
const PRESSED = 0.6;  // where on the colour scale the press zones are

/** The boundary of a body: each point has a value of its own. */
class Boundary extends Model {
  patchBorders() { return []; }

  interpolate(ofPoint) { return ofPoint; }

  triangleOf(facet) { return facet; }
}

/** From the middle to the mean of the sites. */
function facing(model, vertices) {
  const sum = [0, 0, 0];
  let count = 0;
  vertices.response_status.forEach((status, v) => {
    if (status === HOLE) return;
    ++count;
    for (let k = 0; k < 3; ++k) sum[k] += vertices.position[3 * v + k];
  });
  const direction = sum.map((s, k) => s / (count || 1) - model.centre[k]);
  return Math.hypot(...direction) > 0.05 * model.radius ? direction : [1, -1, 0.4];
}

function key(name, text) {
  const chip = el('i');
  chip.style.background = `var(--${name})`;
  return el('span', {}, chip, text);
}

export function previewSection(data) {
  const { body, surface, vertices, distance } = data;
  const pick = { ...surface, triangles: surface.facets };
  const model = new Boundary({ surface: pick, vertices });
  const kinds = surface.facet_kind;
  const size = surface.points.length / 3;
  const view = new BodyView(model, {
    facing: facing(model, vertices),
    onPick: () => {},
    describe: () => [],
  });
  view.pick = () => null;
  view.show.borders = false;
  view.inclusions = data.inclusions.map((inclusion) => new Outline(inclusion));
  const bar = new ColourBar();
  const moved = distance ? largest(distance) * MM : 0;
  const legend = el('div', { class: 'keys' });

  const supports = kinds.includes(FIXED) ? key('body-fixed', data.sprung_facets ? 'support (fixed or on springs)' : 'support') : null;
  const ways = {
    zones() {
      surface.facet_kind = pick.facet_kind = kinds;
      view.setField({ ofVertex: new Float32Array(size).fill(PRESSED), low: 0, high: 1 });
      bar.element.style.display = 'none';
      legend.replaceChildren(...[el('span', {}, 'green: press zones'), supports,
        kinds.includes(1) ? key('body-hole', 'not pressed (outside the press zones or beside a support)') : null,
        el('span', {}, 'dots: sites')].filter(Boolean));
    },
    distance() {
      pick.facet_kind = kinds.map((kind) => (kind === FIXED ? FIXED : TOUCHABLE));
      view.setField({ ofVertex: distance.map((d) => (d * MM < LEAST * moved ? NaN : d * MM)), low: 0, high: moved });
      bar.element.style.display = '';
      bar.set('Moved by repair', 'mm', { low: 0, high: moved });
      legend.replaceChildren(...[el('span', {}, `colour: the surface lies up to ${units.length(moved / MM)} from the faces of the file`),
        key('body-hole', 'below a hundredth of that'), supports, el('span', {}, 'dots: sites')].filter(Boolean));
    },
  };
  const choose = el('select', { id: 'preview-colour', onchange: (e) => ways[e.target.value]() },
    distance ? el('option', { value: 'distance' }, 'distance that repair moved the surface') : null,
    el('option', { value: 'zones' }, 'press zones'));
  ways[distance ? 'distance' : 'zones']();

  return el('section', { id: 'preview' },
    el('h1', {}, data.title),
    paragraph('The body before anything is computed on it. Drag to turn.', 'lead'),
    el('div', { class: 'controls' }, el('label', {}, 'Colour', choose),
      el('span', {},
        el('button', { type: 'button', 'aria-label': 'Zoom in', onclick: () => view.zoomBy(1.25) }, '+'), ' ',
        el('button', { type: 'button', 'aria-label': 'Zoom out', onclick: () => view.zoomBy(0.8) }, '\u2212'), ' ',
        el('button', { type: 'button', onclick: () => view.reset() }, 'Reset'))),
    el('div', { class: 'view' }, view.element, bar.element), legend,
    definitions([
      ['Sites', `${units.count(body.sites)} of ${units.count(body.vertices)} response vertices are pressed`],
      ...(body.tetrahedra ? [['Mesh', `${units.count(body.tetrahedra)} tetrahedra, ${units.count(body.nodes)} nodes; boundary edge ${units.length(body.facet_edge)}, patch edge ${units.length(body.patch_edge)} (medians)`],
      ['Supports', `${units.count(body.fixed_nodes)} fixed nodes, ${units.count(data.sprung_facets)} facets on springs`],
      ['Regions', body.regions.map((r) => `${r.name} (${units.count(r.tetrahedra)} tetrahedra)`).join(', ')]] : []),
      ['Repair', distance ? `moved the surface by up to ${units.length(moved / MM)}` : 'none was needed, or the file was not a surface'],
    ], 'facts'));
}
