// SPDX-License-Identifier: AGPL-3.0-or-later
import { definitions, el, paragraph } from '../dom.js';
import * as units from '../units.js';

const small = (text) => el('small', {}, text);

function sites(key) {
  const total = key.complete + key.partial + key.failed;
  return [units.count(key.complete), small(` of ${units.count(total)} complete`)];
}

function tile(term, value, note, id, kind) {
  return el('div', {}, el('dt', {}, term), el('dd', { id, class: kind }, value),
    note ? el('p', { class: 'note' }, note) : null);
}

const BY = { curves: 'by the curves themselves', limiter: 'by the runtime, which rate-limits slides' };

/** What is guaranteed, on which device, from which rate, and by what. */
function guaranteed(certificate) {
  const term = 'Guaranteed passive';
  if (!certificate) return tile(term, 'nothing', 'The library has not been certified.', 'guaranteed', 'warn');
  const by = BY[certificate.guaranteed_by];
  if (!by) return tile(term, 'nothing', 'Slides have no bound: see the certificate.', 'guaranteed', 'warn');
  const rated = certificate.devices.filter((d) => d.certified).sort((a, b) => a.lowest_rate - b.lowest_rate);
  const limit = `the force changes by at most ${units.bound(certificate.lipschitz_bound)}, ${by}`;
  if (!rated.length) return tile(term, 'at no rate', `${certificate.devices.length ? 'No device with all constants known' : 'No device profile'} was given; ${limit}.`, 'guaranteed', 'warn');
  return tile(term, ['from ', units.lowestRate(rated[0].lowest_rate)], `on ${rated[0].device}; ${limit}`, 'guaranteed');
}

function keyFigures(data, nodes) {
  const { key } = data;
  const bad = key.partial + key.failed;
  const range = nodes.stiffest < 0 ? '\u2013'
    : [units.significant(nodes.softestValue), '\u2009\u2013\u2009', units.significant(nodes.stiffestValue), small('\u00a0N/m')];
  return el('dl', { class: 'figures' },
    tile('Sites', sites(key), `${units.count(key.partial)} partial, ${units.count(key.failed)} failed`, 'sites', bad ? 'warn' : undefined),
    tile('Deepest press', units.length(key.deepest), `requested ${units.length(key.depth)}`, 'deepest'),
    tile('Largest force', units.force(key.max_force), 'of any state of the curves', 'max-force'),
    tile('Stiffness', range, `secant, over ${units.length(key.depth)}; softest to stiffest node`, 'stiffness-range'),
    guaranteed(data.certificate),
    tile('Library', key.library_bytes ? units.bytes(key.library_bytes) : '\u2013',
      `${units.count(key.library_vertices)} nodes, ${units.count(key.library_triangles)} triangles`, 'library-bytes'));
}

/** Keys whose values are no plain words. */
const WORDED = {
  relaxation: (series) => `relaxes by ${[...series.matchAll(/fraction = ([^,]+), time = "([^"]+)"/g)]
    .map(([, fraction, time]) => `${fraction} in ${time}`).join(' and ')}`,
  moduli: (kind) => `${kind} moduli`,
};

/** A [[material]] table, a list of [key, value], as one line. */
export function materialLine(pairs) {
  const get = Object.fromEntries(pairs);
  // A density of 0 stands for that of [gravity].
  const shown = ([k, v]) => k !== 'region' && k !== 'law' && !(k === 'density' && v.startsWith('0 '));
  const rest = pairs.filter(shown).map(([k, v]) => WORDED[k]?.(v) ?? `${k} ${v}`);
  return `${get.region ?? 'body'}: ${[get.law, ...rest].filter(Boolean).join(', ')}`;
}

/** [[material]] tables of the stage that solved, one line each. */
function materialLines(data) {
  const steps = data.provenance.filter((s) => s.materials.length > 0);
  const step = steps.find((s) => s.stage === 'precompute') ?? steps[steps.length - 1];
  if (!step) return ['not recorded in the provenance'];
  return step.materials.map(materialLine);
}

/** Of all tetrahedra. */
const quality = (q) => `dihedral angles ${units.significant(q.smallest_dihedral)}\u00b0 to ${units.significant(q.largest_dihedral)}\u00b0, `
  + `longest over shortest edge of a tetrahedron at most ${units.significant(q.largest_edge_ratio)}, longest edge ${units.length(q.longest_edge)}; `
  + `volume ${units.volume(q.volume)}`;
/** What the presses do to the volume of the body and to its elements; null where it is not known. */
function pressed({ key, body }) {
  if (!Number.isFinite(key.min_jacobian)) return null;
  const of = Number.isFinite(key.volume_change)
    ? `; the volume of the body changes by ${units.volume(key.volume_change)} at most, ${units.percent(Math.abs(key.volume_change) / body.quality.volume)}` : '';
  return `det F, the volume of deformed tissue over that at rest, is nowhere below ${units.significant(key.min_jacobian)}${of}`;
}
const linesOf = (texts) => texts.flatMap((t, i) => (i ? [el('br'), t] : [t]));

/** A measured surface has neither mesh nor supports nor material. */
function bodyLines(data) {
  const { body } = data;
  if (!body.tetrahedra) {
    return [['Surface', `measured at ${units.count(body.sites)} sites: ${units.count(body.triangles)} triangles, edge ${units.length(body.patch_edge)} (median); its inside is unknown`]];
  }
  return [
    ['Mesh', `${units.count(body.tetrahedra)} tetrahedra, ${units.count(body.nodes)} nodes; boundary edge ${units.length(body.facet_edge)}, patch edge ${units.length(body.patch_edge)} (medians)`],
    ['Quality', quality(body.quality)],
    ['Under the tool', pressed(data)],
    ['Supports', `${units.count(body.fixed_nodes)} fixed nodes; ${body.sprung_facets ? `${units.count(body.sprung_facets)} facets on springs; ` : ''}${units.count(body.sites)} of ${units.count(body.vertices)} response nodes may be pressed`],
    ['Regions', body.regions.map((r) => `${r.name} (${units.count(r.tetrahedra)} tetrahedra)`).join(', ')],
    ['Materials', data.certificate?.basis === 'measured' ? 'in no curve: all of them are measured' : linesOf(materialLines(data))],
  ].filter(([, line]) => line !== null);
}

export function headerSection(data, nodes) {
  const { body, key } = data;
  const last = data.provenance[data.provenance.length - 1];
  return el('header', {},
    el('h1', {}, data.title),
    paragraph(last ? `Response library of \u201c${body.name}\u201d \u00b7 palpate ${last.version} (${last.git_revision}) \u00b7 ${last.utc}`
      : `Response library of \u201c${body.name}\u201d \u00b7 provenance not recorded`, 'lead'),
    keyFigures(data, nodes),
    definitions([
      ['Tool', `${key.tool_shape}, radius ${units.length(key.tool_radius)}, normal path ${key.tool_friction}; lateral travel ${units.length(key.lateral_travel)}`],
      ...bodyLines(data),
    ], 'facts'));
}
