// SPDX-License-Identifier: AGPL-3.0-or-later
// Timings and provenance.
import { SITE } from '../data.js';
import { el, paragraph, table } from '../dom.js';
import { histogram } from '../plot.js';
import * as units from '../units.js';

function sitePanel(data) {
  const seconds = Array.from(data.vertices.cpu_seconds).filter((_, v) => data.vertices.site_status[v] !== 255);
  if (!seconds.some((s) => s > 0)) return el('div', {}, el('h3', {}, 'Time to compute a site'), paragraph('The curves have no computing times.'));
  return el('div', {},
    histogram('Time to compute a site', 'Processor time (s)', 'Sites', [{ label: 'sites', colour: 'series-1', values: seconds }]),
    paragraph(`${units.count(seconds.length)} sites, ${units.duration(data.key.cpu_seconds)} of CPU time in all.`, 'note'));
}

function latencyPanel(session) {
  const head = el('h3', {}, 'Time to compute a step of the force loop');
  if (!session) return el('div', {}, head, paragraph('No recording was given.'));
  if (!session.latency) return el('div', {}, head, paragraph('The recording has no step times.'));
  const l = session.latency;
  return el('div', {}, head,
    table(['Percentile', 'Time'], [['50 %', units.time(l.p50)], ['99 %', units.time(l.p99)], ['99.9 %', units.time(l.p999)], ['largest', units.time(l.max)]], [1]),
    paragraph(`Over ${units.count(l.steps)} steps; one period at ${units.frequency(session.rate)} is ${units.time(1 / session.rate)}.`, 'note'));
}

function failures(data) {
  const { vertices } = data;
  const rows = Object.entries(vertices.reasons).map(([v, reason]) => [v, SITE[vertices.site_status[v]], reason]);
  if (rows.length === 0) return null;
  return el('details', {}, el('summary', {}, `${units.count(rows.length)} incomplete sites and their reasons`), table(['Node', 'Site', 'Reason'], rows, [0]));
}

function stage(step) {
  const inputs = el('ul', { class: 'list' }, step.inputs.map((i) => el('li', {}, i.name, el('code', { class: 'hash', title: i.sha256 }, i.sha256.slice(0, 16) + '\u2026'))));
  const facts = el('ul', { class: 'list' }, step.facts.map(([k, v]) => el('li', {}, `${k}: ${v}`)));
  return [step.stage, step.version, el('code', {}, step.git_revision), el('span', { class: 'hash' }, step.utc), inputs, facts];
}

function resolvedCases(chain) {
  return chain.filter((s) => s.resolved_case).map((s) =>
    el('details', {}, el('summary', {}, `Case of \u201c${s.stage}\u201d as resolved, with defaults`), el('pre', {}, s.resolved_case)));
}

function hashes(chain) {
  const rows = chain.flatMap((s) => s.inputs.map((i) => [s.stage, i.name, el('code', {}, i.sha256)]));
  return rows.length ? el('details', {}, el('summary', {}, 'Checksums in full'), table(['Stage', 'Input', 'SHA-256'], rows)) : null;
}

export function recordSection(data) {
  const chain = data.provenance;
  return el('section', { id: 'record' },
    el('h2', {}, 'Timings'),
    el('div', { class: 'pair' }, sitePanel(data), latencyPanel(data.session)), failures(data),
    el('h2', {}, 'Provenance'),
    chain.length === 0 ? paragraph('The artifacts have no provenance.')
      : [table(['Stage', 'Version', 'Revision', 'UTC', 'Inputs (SHA-256)', 'Facts'], chain.map(stage)), hashes(chain), resolvedCases(chain)]);
}
