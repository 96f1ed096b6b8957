// SPDX-License-Identifier: AGPL-3.0-or-later
// Measured records over time, and what a model makes of their motion.
import { el, paragraph, table } from '../dom.js';
import { curvePlot } from '../plot.js';
import * as units from '../units.js';

const COLOURS = ['series-2', 'series-3', 'series-5'];

/** Records that are compared with several models, once each. */
function byRecord(records) {
  const found = new Map();
  for (const r of records) {
    const key = `${r.record}, node ${r.vertex}`;
    found.set(key, [...(found.get(key) ?? []), r]);
  }
  return found;
}

function figures(records) {
  const groups = [...byRecord(records)];
  const place = el('div', {});
  const show = (i) => {
    const models = groups[i][1], first = models[0];
    const force = curvePlot('Force over time', 'Time (s)', 'Force (N)', 260, { signed: true, tight: true });
    const error = curvePlot('Error over time', 'Time (s)', 'Model less measured (N)', 180, { signed: true, tight: true });
    const travel = curvePlot('Travel over time', 'Time (s)', 'Travel (mm)', 140, { signed: true, tight: true });
    force.set([{ label: 'measured', colour: 'series-1', x: first.time_s, y: first.measured_N },
      ...models.map((m, k) => ({ label: m.model, colour: COLOURS[k % COLOURS.length], x: m.time_s, y: m.model_N }))]);
    error.set(models.map((m, k) => ({ label: m.model, colour: COLOURS[k % COLOURS.length], x: m.time_s, y: m.model_N.map((f, j) => f - m.measured_N[j]) })));
    travel.set([{ label: 'travel', colour: 'muted', x: first.time_s, y: first.travel_m.map((d) => d * 1e3) }]);
    place.replaceChildren(force.element, error.element, travel.element);
  };
  const select = el('select', { id: 'compared-record', onchange: (e) => show(Number(e.target.value)) },
    groups.map(([name], i) => el('option', { value: i }, name)));
  show(0);
  return [el('div', { class: 'controls' }, el('label', {}, 'Record', select)), place];
}

const unknown = (v, shown) => (v === null ? '\u2013' : shown(v));

export function overTimePage(data) {
  const c = data.over_time;
  return el('div', {}, el('h1', {}, data.title), el('section', { id: 'over-time' },
    el('h2', {}, 'Over time'),
    paragraph(`Measured records and the forces that a model gives for the same motion. Source: ${c.source}.`, 'lead'),
    figures(c.records),
    table(['Record', 'Model', 'RMSE', 'of the largest force', 'Bias', 'Worst', 'at', 'Lost, measured', 'Lost, model'],
      c.records.map((r) => [r.record, r.model, units.force(r.rmse_N), units.percent(r.normalised_rmse), units.force(r.bias_N),
        units.force(r.worst_N), units.time(r.worst_at_s), unknown(r.measured_loss_J, units.energy), unknown(r.model_loss_J, units.energy)]),
      [2, 3, 4, 5, 6, 7, 8]),
    table(['Hold', 'from', 'to', 'Force that is left, measured', 'by the model'], c.records.flatMap((r) => r.holds.map((h) => [
      `${r.record}, ${r.model}`, units.time(h.from_s), units.time(h.to_s), units.percent(h.measured_left), units.percent(h.model_left)])), [1, 2, 3, 4])));
}
