// SPDX-License-Identifier: AGPL-3.0-or-later
// A calibration: data and fit, residuals, intervals, correlations, profiles.
import { definitions, el, paragraph, table } from '../dom.js';
import { curvePlot } from '../plot.js';
import * as units from '../units.js';

const UNITS = { Pa: units.pressure, m: units.length, N: units.force, s: units.time };

/** A value of a constant with its unit. */
const shown = (unit) => UNITS[unit] ?? ((v) => `${units.significant(v)}${unit === '1' ? '' : ` ${unit}`}`);

function interval(c, low, high) {
  if (low === null && high === null) return '\u2013';
  const end = (v) => (v === null ? 'no end' : shown(c.unit)(v));
  return `${end(low)} to ${end(high)}`;
}

function constantRows(constants) {
  return constants.map((c) => [c.name, shown(c.unit)(c.value),
    c.at_bound ? 'at its bound' : interval(c, c.low, c.high), interval(c, c.profile_low, c.profile_high)]);
}

/** With more constants than this, those of single sites are summarised. */
const MANY = 12;
const isLong = (c) => c.constants.length > MANY;

/** Constants that sites have alike, by what they are; `shared` are the others. */
function groupsOf(constants) {
  const shared = [], groups = new Map();
  constants.forEach((c, i) => {
    const [, what] = /^(.+?)(?: at \S+ \S+)? of site /.exec(c.name) ?? [];
    if (what === undefined) shared.push(i);
    else groups.set(what, [...(groups.get(what) ?? []), i]);
  });
  return { shared, groups: [...groups].map(([what, of]) => ({ what, of })) };
}

function quantile(values, q) {
  const sorted = values.filter((v) => v !== null).sort((a, b) => a - b);
  return sorted.length ? sorted[Math.round(q * (sorted.length - 1))] : null;
}

const HEAD = (c) => ['Constant', 'Value', `${units.percent(c.confidence)} interval`, 'by its profile'];

function groupRow(c, { what, of }) {
  const members = of.map((i) => c.constants[i]), show = shown(members[0].unit);
  const values = members.map((m) => m.value), half = members.map((m) => (m.low === null ? null : 0.5 * (m.high - m.low)));
  const width = quantile(half, 0.5);
  return [`${what} of ${units.count(of.length)} sites`, `median ${show(quantile(values, 0.5))}, from ${show(quantile(values, 0))} to ${show(quantile(values, 1))}`,
    width === null ? '\u2013' : `median \u00b1 ${show(width)}`, '\u2013'];
}

function constantTables(c) {
  if (!isLong(c)) return table(HEAD(c), constantRows(c.constants), [1, 2, 3]);
  const { shared, groups } = groupsOf(c.constants);
  return [table(HEAD(c), [...constantRows(shared.map((i) => c.constants[i])), ...groups.map((g) => groupRow(c, g))], [1, 2, 3]),
    el('details', {}, el('summary', {}, `All ${units.count(c.constants.length)} constants`),
      table(HEAD(c), constantRows(c.constants), [1, 2, 3]))];
}

const PRESSURES = [[1e6, 'MPa'], [1e3, 'kPa'], [1, 'Pa'], [1e-3, 'mPa']];

/** What is compared: tests of specimens, or paths on a body, in one form. */
function recordsOf(c) {
  if (c.tests) {
    return c.tests.map((t) => ({
      name: `${t.test}, ${t.mode}`, x: t.deformation, measured: t.measured_nominal_Pa, fitted: t.fitted_nominal_Pa,
      xLabel: t.mode === 'simple shear' ? 'Amount of shear' : 'Stretch', factor: 1, yName: 'Nominal stress', steps: PRESSURES,
    }));
  }
  if (c.records) {
    return c.records.map((r) => {
      const creep = r.held === 'force';
      return {
        name: r.file, x: r.time_s, measured: creep ? r.travel_m : r.force_N, fitted: creep ? r.fitted_m : r.fitted_N,
        xLabel: 'Time (s)', factor: 1, dense: true, yName: creep ? 'Travel' : 'Force', steps: creep ? units.LENGTHS : units.FORCES,
      };
    });
  }
  const sets = new Set(c.paths.map((p) => p.curves)).size;
  return c.paths.map((p) => {
    const [unit, symbol] = units.stepOf(p.displacement_m, units.LENGTHS, 0.1);
    return {
      name: `node ${p.vertex}, ${p.kind}${sets > 1 ? `, curves ${p.curves}` : ''}`, x: p.displacement_m, measured: p.measured_N, fitted: p.fitted_N,
      xLabel: `Displacement (${symbol})`, factor: 1 / unit, yName: 'Force', steps: units.FORCES,
    };
  });
}

const ascending = (x) => Array.from(x.keys()).sort((a, b) => x[a] - x[b]);

/** Points may have equal abscissas; an invisible shift makes them distinct. */
function distinct(x) {
  const seen = new Set();
  return x.map((v) => {
    while (seen.has(v)) v += 1e-9 * (1 + Math.abs(v));
    seen.add(v);
    return v;
  });
}

function recordFigures(c) {
  const records = recordsOf(c);
  const place = el('div', {});
  const show = (i) => {
    const r = records[i], order = ascending(r.x), x = distinct(order.map((k) => r.x[k] * r.factor));
    const [unit, symbol] = units.stepOf(r.measured, r.steps);
    const off = order.map((k) => r.fitted[k] - r.measured[k]);
    const [small, smallSymbol] = units.stepOf(off, r.steps);
    const data = curvePlot('Data and fit', r.xLabel, `${r.yName} (${symbol})`, 260, { signed: true, tight: true });
    const fit = { label: 'fit', colour: 'series-2', x, y: order.map((k) => r.fitted[k] / unit) };
    const measured = { label: 'data', colour: 'series-1', x, y: order.map((k) => r.measured[k] / unit) };
    data.set(r.dense ? [measured, fit] : [fit, { ...measured, markers: true }]);
    const residuals = curvePlot('Residuals', r.xLabel, `Fit less data (${smallSymbol})`, 180, { signed: true, tight: true });
    residuals.set([
      { label: 'zero', colour: 'muted', width: 1.5, x: [x[0], x[x.length - 1]], y: [0, 0] },
      { label: 'residual', colour: 'series-1', markers: !r.dense, x, y: off.map((v) => v / small) },
    ]);
    place.replaceChildren(data.element, residuals.element);
  };
  const select = el('select', { id: 'calibrated-record', onchange: (e) => show(Number(e.target.value)) },
    records.map((r, i) => el('option', { value: i }, r.name)));
  show(0);
  return [el('div', { class: 'controls' }, el('label', {}, 'Record', select)), place,
    paragraph(c.records ? 'Blue: the record. The other line: the fit.' : 'Markers: the data. Line: the fit at the data.', 'note')];
}

/** The rise of the misfit with one constant fixed, over what chance allows: the interval ends at 1. */
function profileFigures(constants) {
  return constants.filter((c) => c.profile.length > 2).map((c) => {
    const [unit, symbol] = c.unit === 'Pa' ? units.stepOf(c.profile.map(([v]) => v), PRESSURES) : [1, ''];
    const points = c.profile.filter(([, rise]) => rise < 4);
    const x = distinct(points.map(([v]) => v / unit));
    const figure = curvePlot(`Profile of ${c.name}`, symbol ? `${c.name} (${symbol})` : c.name, 'Rise of the misfit', 180, { tight: true });
    figure.set([
      { label: 'end', colour: 'muted', width: 1.5, dash: [6, 4], x: [x[0], x[x.length - 1]], y: [1, 1] },
      { label: 'profile', colour: 'series-1', x, y: points.map(([, rise]) => rise) },
      { label: 'fits', colour: 'series-1', markers: true, x, y: points.map(([, rise]) => rise) },
    ]);
    return figure.element;
  });
}

const correlationText = (v) => (v === null ? '\u2013' : v.toFixed(3).replace('-', '\u2212'));

function correlationTable(c) {
  const names = c.constants.map((k) => k.name);
  return table(['', ...names], c.correlation.map((row, i) => [names[i], ...row.map(correlationText)]), names.map((_, i) => i + 1));
}

/** The largest correlation of one of these constants with one of those, and which they are. */
function largest(c, these, those) {
  let best = null;
  for (const i of these) {
    for (const j of those) {
      const r = c.correlation[i][j];
      if (i !== j && r !== null && (best === null || Math.abs(r) > Math.abs(best.r))) best = { r, i, j };
    }
  }
  if (best === null) return '\u2013';
  const name = (i) => c.constants[i].name;
  return `${correlationText(best.r)}, ${these.length > 1 ? `${name(best.i)} and ` : ''}${name(best.j)}`;
}

/** Shared constants with each other; of those of sites the median and the range, and the largest of all. */
function correlationSummary(c) {
  const { shared, groups } = groupsOf(c.constants), own = groups.flatMap((g) => g.of);
  const row = (name, these) => [name, ...shared.map((j) => {
    const values = these.map((i) => c.correlation[i][j]);
    if (these.length === 1 || values.every((v) => v === null)) return correlationText(values[0]);
    const [low, middle, high] = [0, 0.5, 1].map((q) => correlationText(quantile(values, q)));
    return `${middle} (${low} to ${high})`;
  }), largest(c, these, own)];
  return [table(['', ...shared.map((i) => c.constants[i].name), 'Largest with one of a site'],
    [...shared.map((i) => row(c.constants[i].name, [i])), ...groups.map((g) => row(`${g.what} of ${units.count(g.of.length)} sites`, g.of))],
    shared.map((_, i) => i + 1)),
  paragraph('Of the constants of sites: median, and range over the sites. All correlations are in correlations.csv beside calibration.json.', 'note')];
}

function testRows(c) {
  return c.tests.map((t) => [t.test, t.mode, units.pressure(t.rms_Pa), units.percent(t.relative_rms),
    t.r2 === null ? '\u2013' : t.r2.toFixed(4), t.unstable_at === null ? 'stable' : `unstable at ${units.significant(t.unstable_at)}`]);
}

/** g(t) with its interval, over the logarithm of the time. */
function relaxationFunction(c) {
  const x = c.relaxation_function.map((p) => Math.log10(p.time_s));
  const figure = curvePlot('Relaxation function', 'log10 of the time (s)', 'g', 240, { tight: true });
  const line = (label, key, extra) => ({ label, colour: 'series-1', x, y: c.relaxation_function.map((p) => p[key]), ...extra });
  figure.set([line('g', 'value', {}), line('low', 'low', { dash: [5, 4], width: 1.5 }), line('high', 'high', { dash: [5, 4], width: 1.5 })]);
  const g = c.long_term_fraction;
  return [el('h3', {}, 'What relaxes'), figure.element,
    paragraph(`The force after a step, over that at once. Dashed: the ${units.percent(c.confidence)} interval. The records show what relaxes within ${units.time(c.shortest_time_shown_s)} to ${units.time(c.longest_time_shown_s)}, and say nothing of shorter and longer times. In the long term ${units.percent(g.value)} (${units.percent(g.low)} to ${units.percent(g.high)}) of the force are left.`, 'note'),
    el('pre', {}, c.case_material),
    table(['Terms', 'RMS error', 'AICc', 'BIC', 'Not taken'], c.tried.map((t) => [units.count(t.terms),
      t.relative_rms === null ? '\u2013' : units.percent(t.relative_rms), t.aicc === null ? '\u2013' : t.aicc.toFixed(1),
      t.bic === null ? '\u2013' : t.bic.toFixed(1), t.refused]), [0, 1, 2, 3]),
    table(['Record', 'Held', 'RMS error', 'Elastic force at once', 'in the long term'], c.records.map((r) => [r.file, r.held,
      units.percent(r.relative_rms), units.force(r.instantaneous_force_N.value), units.force(r.long_term_force_N.value)]), [2, 3, 4])];
}

/** A range of which the data may show one end only, as they do of the thickness of a thick slab. */
function identified(range, text) {
  const { value, low, high } = range;
  if (range.identified === 'interval') return `${text(value)}, ${text(low)} to ${text(high)}`;
  if (range.identified === 'upper bound') return `${text(value)}, at most ${text(high)}`;
  if (range.identified === 'lower bound') return `${text(value)}, at least ${text(low)}`;
  return `${text(value)}, which the records do not determine`;
}

function slabFacts(c) {
  const { slab } = c;
  return [definitions([
    ['Law', `${slab.law}, Poisson\u2019s ratio ${units.significant(slab.poisson)}`],
    ['Thickness', identified(slab.thickness_m, units.length)],
    [`Stiffening ${slab.stiffening_name}`, identified(slab.stiffening, units.significant)],
    ['Shear modulus', `${units.pressure(slab.median_shear_modulus_Pa)}, the median of the sites`],
    ['Tried', `thicknesses of ${slab.thickness_range_m.map(units.length).join(' to ')}, ${slab.stiffening_name} of ${slab.stiffening_range.map((x) => units.significant(x)).join(' to ')}`],
  ], 'facts'), el('pre', {}, slab.case_material)];
}

function lead(c) {
  if (c.relaxation) return `A Prony series from ${units.count(c.records.length)} records over time. Source: ${c.source}.`;
  return c.law
    ? `Constants of the law ${c.law}, from ${units.count(c.tests.length)} ${c.tests.length === 1 ? 'test' : 'tests'}. Source: ${c.source}.`
    : `Constants of ${c.slab ? 'a slab' : 'regions of the body'}, from ${units.count(c.paths.length)} measured paths.`;
}

export function calibrationSection(data) {
  const c = data.calibration;
  const profiles = profileFigures(c.constants);
  return el('section', { id: 'calibration' },
    el('h2', {}, 'Calibration'),
    paragraph(lead(c), 'lead'),
    c.slab ? slabFacts(c) : null,
    constantTables(c),
    recordFigures(c),
    c.relaxation ? relaxationFunction(c) : null,
    c.tests ? table(['Test', 'Mode', 'RMS error', 'of its RMS', 'R\u00b2', 'In its range'], testRows(c), [2, 3, 4]) : null,
    c.constants.length > 1 ? [el('h3', {}, 'Correlations'), isLong(c) ? correlationSummary(c) : correlationTable(c)] : null,
    profiles.length ? [el('h3', {}, 'Profiles'),
      paragraph('The misfit with one constant fixed and all others refitted. The interval ends where its rise is 1 (dashed).', 'note'), profiles] : null,
    definitions([
      ['Degrees of freedom', `${units.count(c.degrees_of_freedom)}, effective ${units.significant(c.effective_degrees_of_freedom)}`],
      ['Neighbouring residuals', `correlation ${units.significant(c.residual_lag_one_correlation)}, Durbin\u2013Watson ${units.significant(c.residual_durbin_watson)}; intervals ${units.significant(c.intervals_widened_for_correlation)} times as wide for it`],
    ], 'facts'),
    c.warnings.length ? [el('h3', {}, 'Warnings'), el('ul', {}, c.warnings.map((w) => el('li', {}, w)))] : null);
}

/** The page of a calibration of specimens, without a body. */
export function calibrationPage(data) {
  return el('div', {}, el('h1', {}, data.title), calibrationSection(data));
}
