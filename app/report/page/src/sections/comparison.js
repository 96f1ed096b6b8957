// SPDX-License-Identifier: AGPL-3.0-or-later
// One set of curves against another: overlay of a site, Bland-Altman of all, figures per curve.
import { definitions, el, paragraph, table } from '../dom.js';
import { curvePlot } from '../plot.js';
import * as units from '../units.js';

const difference = (p) => p.model_N - p.reference_N;
const sorted = (sets) => sets.map((s) => {
  const order = Array.from(s.x.keys()).sort((a, b) => s.x[a] - s.x[b]);
  return { ...s, x: order.map((i) => s.x[i]), y: order.map((i) => s.y[i]) };
});

/** Error of the curves of one kind at each vertex, in just noticeable differences: the root mean
 *  square over its points, and over its curves where a vertex has several. */
export function errorOfVertices(data, kind) {
  const size = data.vertices.response_status.length;
  const squares = new Float64Array(size), count = new Uint32Array(size);
  for (const c of data.comparison.curves) {
    if (c.kind !== kind) continue;
    squares[c.vertex] += c.rms_jnd ** 2;
    count[c.vertex] += 1;
  }
  return Float32Array.from(squares, (sum, v) => (count[v] ? Math.sqrt(sum / count[v]) : NaN));
}

/** Lines of the tip: what the curves of a vertex are off by. */
export function errorsAt(data, vertex) {
  return (data.comparison?.curves ?? []).filter((c) => c.vertex === vertex).map((c) =>
    `${pathName(c)}: root mean square error ${units.force(c.rmse_N)} (${units.significant(c.rms_jnd)}\u00a0JND)`
    + (c.scatter_N === null ? '' : `, scatter ${units.force(c.scatter_N)}`));
}

const pathName = (curve) => (curve.kind === 'lateral' ? `lateral at ${units.scaledLength(curve.lateral_depth_m)}` : curve.kind);

/** Units of length and force in which the curves of a comparison are drawn, all in the same. */
function stepsOf(curves) {
  const points = curves.flatMap((c) => c.points);
  return {
    length: units.stepOf(points.map((p) => p.displacement_m), units.LENGTHS, 0.1),
    force: units.stepOf(points.map((p) => p.reference_N), units.FORCES, 0.1),
  };
}

function overlay(curve, steps) {
  const [length] = steps.length, [force] = steps.force;
  const x = curve.points.map((p) => p.displacement_m / length);
  const band = (sign) => curve.points.map((p) => (p.reference_N + sign * 2 * (p.uncertainty_N ?? 0)) / force);
  const known = curve.points.some((p) => p.uncertainty_N !== null);
  const thin = (sign) => ({ label: 'two standard uncertainties', colour: 'muted', width: 1, dash: [3, 3], x, y: band(sign) });
  return [
    ...(known ? [thin(-1), thin(1)] : []),
    { label: 'model', colour: 'series-2', x, y: curve.points.map((p) => p.model_N / force) },
    { label: 'reference', colour: 'series-1', markers: true, x, y: curve.points.map((p) => p.reference_N / force) },
  ];
}

/** Points may have equal abscissas; an invisible shift makes them distinct. */
function distinct(points) {
  const seen = new Set();
  return points.map(([x, y]) => {
    while (seen.has(x)) x += 1e-9 * (1 + Math.abs(x));
    seen.add(x);
    return [x, y];
  });
}

function blandAltman(data, kind, summary, force) {
  const curves = data.comparison.curves.filter((c) => c.kind === kind);
  const points = distinct(curves.flatMap((c) => c.points.map((p) => [(p.model_N + p.reference_N) / 2 / force, difference(p) / force])));
  const all = points.map(([x]) => x);
  const ends = [Math.min(...all), Math.max(...all)];
  const line = (label, y, dash) => ({ label, colour: 'muted', width: 1.5, dash, x: ends, y: [y / force, y / force] });
  const limit = (y) => line('limit of agreement', y, [6, 4]);
  return sorted([
    line('bias', summary.bias_N), limit(summary.agreement_low_N), limit(summary.agreement_high_N),
    { label: 'points', colour: 'series-1', markers: true, x: all, y: points.map(([, y]) => y) },
  ]);
}

/** The first few of a list that may be as long as the body has sites. */
function someOf(texts, most = 3) {
  const rest = texts.length - most;
  return texts.slice(0, most).join('; ') + (rest > 0 ? `; and ${units.count(rest)} more, in comparison.json` : '');
}

const percentOf = (fraction) => (fraction === null ? 'unknown' : units.percent(fraction));
const forceOf = (f) => (f === null ? 'unknown' : units.force(f));

function summaryOf(s) {
  return definitions([
    ['Compared', `${units.count(s.curves)} ${s.kind} curves, ${units.count(s.points)} points`],
    ['RMSE', `${units.force(s.rmse_N)}, ${percentOf(s.normalised_rmse)} of the largest force; scatter of the reference: ${forceOf(s.scatter_N)}`],
    ['Bias', `${units.force(s.bias_N)}; limits of agreement ${units.force(s.agreement_low_N)} to ${units.force(s.agreement_high_N)}`],
    ['Perception', `${units.significant(s.rms_jnd)} just noticeable differences (root mean square); noticeable at ${percentOf(s.noticeable_fraction)} of the points`],
    ['Within the uncertainty', `${percentOf(s.within_uncertainty_fraction)} of the points`],
    ['Worst', `node ${s.worst_vertex} at ${units.scaledLength(s.worst.displacement_m)}: ${units.force(s.worst.model_N)} for ${units.force(s.worst.reference_N)}`],
  ], 'facts');
}

function curveRows(curves) {
  return curves.map((c) => [String(c.vertex), c.kind, units.force(c.rmse_N), percentOf(c.normalised_rmse),
    c.r2 === null ? '\u2013' : units.significant(c.r2, 4), units.force(c.bias_N), units.significant(c.rms_jnd),
    forceOf(c.uncertainty_N), forceOf(c.scatter_N)]);
}

export function comparisonSection(data) {
  const c = data.comparison;
  const steps = stepsOf(c.curves), [force, forceUnit] = steps.force;
  const plot = curvePlot('One curve: reference and model', `Displacement (${steps.length[1]})`, `Force (${forceUnit})`, 240);
  const name = (curve) => `node ${curve.vertex}, ${pathName(curve)}`;
  const show = (i) => plot.set(overlay(c.curves[i], steps));
  const select = el('select', { id: 'compared-curve', onchange: (e) => show(Number(e.target.value)) },
    c.curves.map((curve, i) => el('option', { value: i }, name(curve))));
  show(0);
  const agreement = c.summaries.map((s) => {
    const figure = curvePlot(`Difference over mean, ${s.kind} curves (Bland\u2013Altman)`, `Mean force (${forceUnit})`, `Model less reference (${forceUnit})`, 240, { signed: true });
    figure.set(blandAltman(data, s.kind, s, force));
    return el('div', {}, figure.element,
      paragraph('Line: bias. Dashed: limits of agreement, bias \u00b1 1.96 standard deviations of the differences.', 'note'),
      summaryOf(s));
  });
  return el('section', { id: 'comparison' },
    el('h2', {}, 'Against the reference'),
    paragraph(`Model: ${c.model}. Reference: ${c.reference}. A difference of ${percentOf(c.jnd)} of the force, or of ${units.force(c.jnd_floor_N)} where that is more, counts as just noticeable.`, 'lead'),
    el('div', { class: 'controls' }, el('label', {}, 'Curve', select)), plot.element,
    paragraph('Markers: the reference. Dashed: two standard uncertainties of it, where known. Line: the model. The error is also a colour of the body above.', 'note'),
    agreement,
    table(['Node', 'Path', 'RMSE', 'of largest', 'R\u00b2', 'Bias', 'JND', 'Uncertainty', 'Scatter'], curveRows(c.curves), [0, 2, 3, 4, 5, 6, 7, 8]),
    c.unmatched.length ? paragraph(`Unmatched: ${someOf(c.unmatched)}.`, 'note') : null);
}
