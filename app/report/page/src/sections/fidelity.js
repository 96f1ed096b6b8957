// SPDX-License-Identifier: AGPL-3.0-or-later
// Rendered forces against direct solutions where no response was fitted.
import { el, paragraph, table } from '../dom.js';
import * as units from '../units.js';

const factsOf = (data) => {
  const step = data.provenance.find((s) => s.stage === 'precompute' && s.facts.some(([k, v]) => k === 'sampling' && v === 'adaptive'));
  return step ? new Map(step.facts) : null;
};

/** "median 0.01, p95 0.05, worst 0.2" as percentages. */
const distribution = (text) => text.replace('p95', '95 % below')
  .replace(/[0-9][0-9.e+-]*(?=,|$)/g, (number) => units.percent(Number(number)));

function sampling(facts) {
  return [
    el('h3', {}, 'Sites chosen by need'),
    paragraph(`${facts.get('sites_computed')} sites were computed in ${facts.get('sampling_rounds')} rounds; the other responses are interpolated. At ${facts.get('hold_out_points')} random points of the surface, never fitted, the error of the force is along the press: ${distribution(facts.get('hold_out_error_along_press'))}; as a vector: ${distribution(facts.get('hold_out_error_of_vector'))}. Sampling ended because ${facts.get('sampling_ended')}.`),
  ];
}

function judgement(f) {
  if (f.other_library) return [paragraph('The judgement in fidelity.json is of another library: run palpate compare --fem again.', 'note')];
  return [
    el('h3', {}, 'Judged afterwards'),
    paragraph(`${units.count(f.off_node)} random points and ${units.count(f.at_node)} nodes, pressed directly and through the runtime; errors are relative to the direct force there, or to ${units.force(f.floor)} where that is larger. Within friction: what a tool reaches without slipping at \u03bc = ${units.significant(f.friction)}.`),
    table(['Force', 'Part', 'States', 'Median', '95 % below', 'Worst'],
      f.rows.map((r) => [r.what, r.part, units.count(r.states), units.percent(r.median), units.percent(r.p95), units.percent(r.worst)]), [2, 3, 4, 5]),
  ];
}

/** null when nothing is known of it. */
export function fidelitySection(data) {
  const facts = factsOf(data);
  if (!facts && !data.fidelity) return null;
  return el('section', { id: 'fidelity' },
    el('h2', {}, 'Does it feel like the body?'),
    paragraph('Forces of the library against direct solutions by finite elements at places that it was not made from. A difference of force below about 7 % is not felt.', 'lead'),
    facts ? sampling(facts) : null,
    data.fidelity ? judgement(data.fidelity) : null);
}
