// SPDX-License-Identifier: AGPL-3.0-or-later
import { el, paragraph } from '../dom.js';
import { timePlot } from '../plot.js';
import { scrubPanel } from './scrub.js';
import * as units from '../units.js';

const scale = (column, factor) => Float64Array.from(column, (x) => x * factor);

function accountSentence(session) {
  const { least, time } = session.margin;
  const holds = least >= -1e-12;
  const guessed = session.counts.beyond_depth > 0 ? ', with extrapolated forces' : '';
  return el('p', { id: 'account', class: holds ? undefined : 'warn' }, holds
    ? `In every step the absorbed energy covered the stored energy: absorbed \u2212 (stored + tank) was at least ${units.energy(Math.max(0, least))}. The session was passive${guessed}.`
    : `The energy account was violated: absorbed \u2212 (stored + tank) fell to ${units.energy(least)} at ${units.significant(time)} s. The session was not passive.`);
}

/** Forces beyond the deepest sample are guesses: a reader sees it before the account. */
function beyondSentence({ session, key }) {
  const { beyond_depth: beyond, contact } = session.counts;
  if (!beyond) return [];
  return [el('p', { id: 'beyond', class: 'warn' }, `${units.count(beyond)} of ${units.count(contact)} steps in contact went beyond the deepest sample (${units.length(key.depth)} was asked for): their forces are extrapolated, not computed. The energy account below holds for these guesses too, but says nothing about the body.`)];
}

function countsSentence(counts, steps) {
  const fraction = (n) => `${units.count(n)} (${units.percent(n / steps)})`;
  const warnings = [['bad_input', 'with bad input'], ['dropped', 'that dropped a contact'], ['at_border', 'at a border']]
    .filter(([k]) => counts[k] > 0).map(([k, text]) => `${units.count(counts[k])} ${text}`);
  return `Steps in contact: ${fraction(counts.contact)}; collisions accepted: ${units.count(counts.activated)}; sliding: ${fraction(counts.sliding)}; ` +
    `limited by the energy rule: ${units.count(counts.energy_limited)}${warnings.length ? `; ${warnings.join(', ')}` : ''}.`;
}

export function sessionSection(data) {
  const { session } = data;
  const head = [el('h2', {}, 'The session')];
  if (!session) return el('section', { id: 'session' }, head, paragraph('No recording was given. palpate simulate makes one.'));
  if (!session.drawn) return el('section', { id: 'session' }, head, paragraph('The recording has no steps.'));
  const d = session.drawn;
  const magnitude = Float64Array.from(d.fx, (x, i) => Math.hypot(x, d.fy[i], d.fz[i]));
  const most = (...columns) => columns.reduce((top, c) => c.reduce((m, x) => Math.max(m, Math.abs(x)), top), 0);
  const force = units.axis.force(session.max_force), length = units.axis.length(most(d.depth, d.lateral));
  const energy = units.axis.energy(most(d.absorbed, d.energy, d.tank));
  const drawn = d.time.length < session.steps ? ` Drawn: ${units.count(d.time.length)} of ${units.count(session.steps)} steps, including all extremes; the numbers are of all steps.` : '';
  return el('section', { id: 'session' }, head,
    paragraph(`${session.device || 'Unnamed device'}, ${units.frequency(session.rate)}, \u03bc = ${units.significant(session.friction)}, ${units.duration(session.duration)}, ${units.count(session.steps)} steps; largest force ${units.force(session.max_force)}.${drawn}`, 'lead'),
    ...beyondSentence(data),
    accountSentence(session),
    scrubPanel(data),
    timePlot('Force commanded to the device', `Force (${force.name})`, d.time, [
      { label: 'x', colour: 'series-1', values: scale(d.fx, force.factor) }, { label: 'y', colour: 'series-2', values: scale(d.fy, force.factor) },
      { label: 'z', colour: 'series-3', values: scale(d.fz, force.factor) }, { label: 'magnitude', colour: 'series-5', values: scale(magnitude, force.factor) }]),
    timePlot('Deflection', `Length (${length.name})`, d.time, [
      { label: 'depth', colour: 'series-1', values: scale(d.depth, length.factor) }, { label: 'lateral', colour: 'series-3', values: scale(d.lateral, length.factor) }], 160),
    timePlot('Energy account', `Energy (${energy.name})`, d.time, [
      { label: 'absorbed', colour: 'series-5', values: scale(d.absorbed, energy.factor) },
      { label: 'stored in the local model', colour: 'series-1', values: scale(d.energy, energy.factor) },
      { label: 'tank', colour: 'series-3', values: scale(d.tank, energy.factor) }], 180),
    paragraph(countsSentence(session.counts, session.steps), 'note'));
}
