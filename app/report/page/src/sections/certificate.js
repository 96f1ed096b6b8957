// SPDX-License-Identifier: AGPL-3.0-or-later
import { definitions, el, paragraph, table } from '../dom.js';
import * as units from '../units.js';
import { hasAssumedPaths } from './curves.js';

const nodes = (n) => `${units.count(n)} ${n === 1 ? 'node' : 'nodes'}`;

/** What the certificate does not cover: general limits, then those of this library. */
function notCovered(data) {
  const { certificate: c, session, key } = data;
  const list = [
    `Depths beyond ${units.length(c.depth)}: the curves are extrapolated linearly there, outside of ${c.lipschitz_bound >= c.min_lipschitz_bound ? 'L_stick and L_slip; the runtime enforces its bound there too' : 'the bounds'}.`,
    'Several simultaneous contacts: their bounds add up.',
    'Quantized positions while the contact point slides, and flexible links, backlash, amplifier limits and missed samples of the device.',
    'Accuracy: the bounds are those of the rendered force, not of its error against the real body.',
  ];
  if (hasAssumedPaths(data)) list.push('Measured drags: lateral responses are assumed, by lateral_ratio of the sidecar times the normal stiffness. The bounds are those of the assumed forces.');
  if (c.holes > 0) list.push(`${nodes(c.holes)} without a response: their triangles form a border and have no bounds.`);
  if (c.interpolated > 0) list.push(`${nodes(c.interpolated)} filled from neighbours: bounded like the others, but not computed.`);
  if (key.deepest > c.depth * (1 + 1e-6)) list.push(`Presses between ${units.length(c.depth)} and ${units.length(key.deepest)}, which were computed but lie deeper than the bounds.`);
  if (session && Math.abs(session.friction - c.friction) > 1e-9) list.push(`The friction of the session, \u03bc = ${units.significant(session.friction)}: the bounds were computed for ${units.significant(c.friction)}.`);
  return list;
}

function devices(c) {
  if (c.devices.length === 0) return paragraph('No device profile was given: the bounds are valid, but no rate is guaranteed on any device.', 'warn');
  return table(['Device', 'Guarantee', 'Damping, N\u00b7s/m', 'Mahvash & Hayward 2005, Hz', 'Linear limit at 1 kHz, N/m', 'Without delay, N/m'],
    c.devices.map((d) => [d.device, d.verdict, units.significant(d.damping), units.significant(d.published_rate), units.significant(d.linear_limit), units.significant(d.no_delay_limit)]), [2, 3, 4, 5]);
}

export function certificateSection(data) {
  const c = data.certificate;
  const head = el('h2', {}, 'Passivity certificate');
  if (!c) return el('section', { id: 'certificate' }, head, paragraph('Nothing is guaranteed: this library has not been certified, and it is unknown at which rate a device renders it passively. Run palpate certify.'));
  const free = c.triangle_sliding_passive.reduce((n, x) => n + x, 0);
  return el('section', { id: 'certificate' }, head,
    el('p', { id: 'guarantee', class: c.guaranteed_by === 'nothing' ? 'warn' : 'lead' }, `${c.guarantee[0].toUpperCase()}${c.guarantee.slice(1)}.`),
    el('h3', {}, 'Devices'), devices(c),
    paragraph('Passive: the rendered body never returns more energy than it absorbed. It is where \u03c3\u2080(B) \u2265 L (3/2 T + \u221a(\u03c4 T)), with L the enforced bound, \u03c3\u2080(B) the smallest damping of the device, \u03c4 its delay and 1/T the rate of its force loop, and where its dry friction makes up for the steps of its positions and forces: \u03c3\u2080(S) \u2265 \u221a3/2 (L q + r).', 'note'),
    el('h3', {}, 'Bounds'),
    definitions([
      ['L_stick', `${units.bound(c.stick)}; fixed contact point`],
      ['L_slip', `${units.bound(c.slip)}; while sliding, \u03bc = ${units.significant(c.friction)}`],
      ['L_min', Number.isFinite(c.min_lipschitz_bound) ? `${units.bound(c.min_lipschitz_bound)}; smallest enforceable bound, with rate-limited slides` : 'unknown'],
      ['Enforced bound', `${units.bound(c.lipschitz_bound)}: in each step the force changes by at most this times the travel of the tool`],
      ['Responses', c.basis],
      ['Valid to', `a depth of ${units.length(c.depth)}`],
      ['Worst triangle', c.worst_triangle < 0 ? 'none' : `${c.worst_triangle}: ${c.limited_by || 'cause not recorded'}`],
      ['Sliding', `${units.count(free)} of ${units.count(c.triangle_slip.length)} triangles need no energy correction while sliding`],
    ], 'facts'),
    el('h3', {}, 'Not covered'), el('ul', {}, notCovered(data).map((text) => el('li', {}, text))),
    paragraph('Both bounds can be chosen as the colour of the body above.', 'note'));
}
