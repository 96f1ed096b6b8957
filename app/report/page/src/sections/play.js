// SPDX-License-Identifier: AGPL-3.0-or-later
// The head of a page that has a library alone.
import { rangeOf } from '../colour-range.js';
import { HOLE } from '../data.js';
import { definitions, el, paragraph } from '../dom.js';
import { secantField } from './secant-field.js';
import { materialLine } from './header.js';
import * as units from '../units.js';

function originText(last) {
  return last ? ` It was computed by palpate ${last.version}, ${last.utc.slice(0, 10)}.` : '';
}

export function playHeader(data) {
  const { key, vertices, provenance } = data;
  const { low, high } = rangeOf(secantField(data).ofVertex, 'all');
  const pressed = vertices.response_status.filter((status) => status !== HOLE).length;
  const materials = provenance.find((step) => step.stage === 'precompute')?.materials ?? [];
  return el('header', {},
    el('h1', {}, data.title),
    paragraph(`A response library, to be touched.${originText(provenance.at(-1))}`, 'lead'),
    definitions([
      ['Tool', `${key.tool_shape}, radius ${units.length(key.tool_radius)}, pressed at most ${units.length(key.depth)}`],
      ['Stiffness', `${units.significant(low)} to ${units.significant(high)}\u00a0N/m, secant at that depth; the colour of the body`],
      ['Nodes', `${units.count(pressed)} of ${units.count(vertices.response_status.length)} have responses; grey parts have none`],
      ...(materials.length ? [['Materials', materials.flatMap((m, i) => (i ? [el('br'), materialLine(m)] : [materialLine(m)]))]] : []),
    ], 'facts'));
}
