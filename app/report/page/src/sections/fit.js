// SPDX-License-Identifier: AGPL-3.0-or-later
import { el, paragraph } from '../dom.js';
import { histogram } from '../plot.js';
import * as units from '../units.js';

const relative = (error, peak) =>
  Array.from(error, (e, v) => (peak[v] > 0 ? (100 * e) / peak[v] : NaN)).filter(Number.isFinite);
const quantile = (values, q) => {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.max(0, Math.ceil(q * sorted.length) - 1)];
};

/** What the mesh of the campaign leaves in the normal forces: known where sites were pressed on a finer one. */
function meshSentence(v, confidence) {
  const errors = relative(v.mesh_error, v.normal_peak);
  if (!errors.length) return el('p', { id: 'mesh-error', class: 'note' }, 'The error of the mesh in the forces is unknown.');
  return el('p', { id: 'mesh-error', class: 'note' },
    `The mesh leaves an error of the normal force of at most ${units.percent(quantile(errors, 0.5) / 100)} of the largest force at the median node, ${units.percent(quantile(errors, 1) / 100)} at the worst (confidence ${units.percent(confidence)}).`);
}

function fitPanel(v) {
  const normal = relative(v.normal_error, v.normal_peak), lateral = relative(v.lateral_error, v.lateral_peak);
  if (normal.length + lateral.length === 0) return el('div', {}, el('h3', {}, 'Fit error'), paragraph('No node has a response from its own curves.'));
  const summary = (name, x) => (x.length ? `${name}: median ${units.percent(quantile(x, 0.5) / 100)}, worst ${units.percent(quantile(x, 1) / 100)}` : `${name}: none`);
  return el('div', {},
    histogram('Fit error', 'Largest deviation (% of the largest force of the node)', 'Nodes',
      [{ label: 'normal', colour: 'series-1', values: normal }, { label: 'lateral', colour: 'series-3', values: lateral }]),
    paragraph(`${summary('Normal', normal)}. ${summary('Lateral', lateral)}.`, 'note'));
}

/** How far the forces are from converged ones: of the mesh and of the fit. */
function accuracySentence(text) {
  if (!text) return null;
  return el('p', { id: 'accuracy', class: 'lead' }, `${text[0].toUpperCase()}${text.slice(1)}.`);
}

const MOST_NAMED = 5;

/** Nodes whose response visibly misses what was computed, the worst first. */
export function misfits(v) {
  const nodes = [];
  v.misfit.forEach((error, vertex) => { if (error > v.visible_misfit) nodes.push({ vertex, error }); });
  return nodes.sort((a, b) => b.error - a.error);
}

export const positionOf = (v, vertex) => Array.from(v.position.subarray(3 * vertex, 3 * vertex + 3));

function misfitSentence(v) {
  const nodes = misfits(v);
  if (!nodes.length) return null;
  const named = nodes.slice(0, MOST_NAMED).map((n) => `node ${n.vertex} at ${units.place(positionOf(v, n.vertex))} by ${units.percent(n.error)}`).join('; ');
  const more = nodes.length > MOST_NAMED ? `; and ${units.count(nodes.length - MOST_NAMED)} more` : '';
  return el('p', { id: 'misfits', class: 'warn' }, `${units.count(nodes.length)} ${nodes.length === 1 ? 'node misses its' : 'nodes miss their'} curves by more than ${units.percent(v.visible_misfit)} of the largest force: ${named}${more}. They are marked by triangles on the body.`);
}

function balancePanel(balance) {
  if (!balance.worst) return el('div', {}, el('h3', {}, 'Energy balance'), paragraph('The curves have no stored energy.'));
  const of = (kind) => Array.from(balance.difference).filter((_, i) => balance.kind[i] === kind).map((x) => 100 * x);
  const w = balance.worst;
  return el('div', {},
    histogram('Energy balance of the curves', '(work of the tool \u2212 stored energy) / larger of the two (%)', 'Paths',
      [{ label: 'normal', colour: 'series-1', values: of(0) }, { label: 'lateral', colour: 'series-3', values: of(1) }], { zero: true }),
    el('p', { class: 'note', id: 'worst-balance' },
      `Worst: node ${w.vertex}, ${w.kind === 0 ? 'normal' : 'lateral'} path, ${units.percent(w.difference)} (work ${units.energy(w.work)}, stored ${units.energy(w.energy)}).`));
}

export function fitSection(data) {
  return el('section', { id: 'fit' },
    el('h2', {}, 'Errors of the curves'),
    paragraph('The distance of the fit from the states of the curves, and the difference between the work of the tool and the energy stored in the body and its contact.', 'lead'),
    accuracySentence(data.key.accuracy),
    misfitSentence(data.vertices),
    meshSentence(data.vertices, data.key.mesh_error_confidence),
    el('div', { class: 'pair' }, fitPanel(data.vertices), balancePanel(data.balance)));
}
