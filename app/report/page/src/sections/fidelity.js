// SPDX-License-Identifier: AGPL-3.0-or-later
// Rendered forces against direct solutions at hold-out points.
import { el, paragraph, table } from '../dom.js';
import * as units from '../units.js';

const factsOf = (data) => {
  const step = data.provenance.find((s) => s.stage === 'precompute' && s.facts.some(([k, v]) => k === 'sampling' && v === 'adaptive'));
  return step ? new Map(step.facts) : null;
};

/** "median 0.01, p95 0.05, worst 0.2" as percentages. */
const distribution = (text) => text.replace('p95', '95th percentile')
  .replace(/[0-9][0-9.e+-]*(?=,|$)/g, (number) => units.percent(Number(number)));

function sampling(facts) {
  return [
    el('h3', {}, 'Adaptive sampling'),
    paragraph(`${facts.get('sites_computed')} sites were computed in ${facts.get('sampling_rounds')} rounds; the other responses are interpolated. Relative errors of the force at ${facts.get('hold_out_points')} hold-out points: along the press ${distribution(facts.get('hold_out_error_along_press'))}; as a vector ${distribution(facts.get('hold_out_error_of_vector'))}. End of sampling: ${facts.get('sampling_ended')}.`),
  ];
}

function comparison(f) {
  if (f.other_library) return [paragraph('The comparison in fidelity.json is of another library: run palpate compare --fem again.', 'note')];
  return [
    el('h3', {}, 'Comparison with direct solutions'),
    paragraph(`${units.count(f.off_node)} random points and ${units.count(f.at_node)} nodes, pressed by finite elements and through the runtime; errors are relative to the direct force or to ${units.force(f.floor)}, whichever is larger. Within friction: states that a tool reaches without slip at \u03bc = ${units.significant(f.friction)}.`),
    table(['Force', 'Part', 'States', 'Median', '95th percentile', 'Worst'],
      f.rows.map((r) => [r.what, r.part, units.count(r.states), units.percent(r.median), units.percent(r.p95), units.percent(r.worst)]), [2, 3, 4, 5]),
  ];
}

/** null without a fidelity. */
export function fidelitySection(data) {
  const facts = factsOf(data);
  if (!facts && !data.fidelity) return null;
  return el('section', { id: 'fidelity' },
    el('h2', {}, 'Model accuracy'),
    paragraph('Rendered forces against direct finite element solutions at hold-out points. A relative difference of force below about 7 % is not noticeable.', 'lead'),
    facts ? sampling(facts) : null,
    data.fidelity ? comparison(data.fidelity) : null);
}
