// SPDX-License-Identifier: AGPL-3.0-or-later
// The surface of the file beside its repair, in the colours of the distance between them.
import { BodyView } from '../body-view.js';
import { el, paragraph } from '../dom.js';
import { Model } from '../model.js';
import { ColourBar } from './body.js';
import * as units from '../units.js';

const MM = 1e3;
const LEAST = 0.01;  // of the scale; what lies nearer is grey, so that its shape is seen

/** A surface without responses: each point has a value of its own. */
export class PlainModel extends Model {
  constructor({ points, facets }) {
    super({ surface: { points, facets }, vertices: { position: points, response_status: [] } });
    // Both sides of an open surface are seen.
    const back = Uint32Array.from(facets, (_, i) => facets[i % 3 === 0 ? i : i % 3 === 1 ? i + 1 : i - 1]);
    this.facets = Uint32Array.from([...facets, ...back]);
    this.surface = { ...this.surface, triangles: this.facets, facet_kind: new Uint8Array(this.facets.length / 3) };
  }

  patchBorders() { return []; }

  interpolate(ofPoint) { return ofPoint; }

  triangleOf(facet) { return facet; }
}

export const largest = (values) => values.reduce((most, x) => Math.max(most, x), 0);

/** From the middle to the point with the largest distance. */
function facing(model, distance) {
  const p = distance.indexOf(largest(distance));
  const direction = model.centre.map((c, k) => model.points[3 * p + k] - c);
  return Math.hypot(...direction) > 0 ? direction : [1, -1, 0.4];
}

function view(map, frame, direction, name) {
  const model = new PlainModel(map);
  [model.centre, model.radius] = [frame.centre, frame.radius];
  const made = new BodyView(model, {
    facing: direction,
    onPick: () => {},
    describe: ({ vertex }) => [`${units.length(map.distance[vertex])} from the ${name}`],
  });
  Object.assign(made.show, { nodes: false, borders: false });
  made.canvas.setAttribute('aria-label', `Distance from the ${name}. Arrow keys turn it.`);
  return made;
}

/** Turning one picture turns the other one. */
function turnTogether(one, other) {
  one.draw = (fast) => {
    BodyView.prototype.draw.call(one, fast);
    other.camera = one.camera;
    BodyView.prototype.draw.call(other, fast);
  };
}

export function repairSection({ repair }) {
  const section = (...content) => el('section', { id: 'repair' }, el('h2', {}, 'Repair of the surface'), ...content);
  if (repair.other_surface) {
    return section(paragraph('repair.json is of another surface: run palpate mesh again.', 'note'));
  }
  const { file, repaired } = repair;
  const moved = largest(file.distance), added = largest(repaired.distance);
  const frame = new PlainModel(repaired);
  const direction = moved >= added ? facing(new PlainModel(file), file.distance) : facing(frame, repaired.distance);
  const left = view(file, frame, direction, 'repaired surface'), right = view(repaired, frame, direction, 'file');
  turnTogether(left, right);
  turnTogether(right, left);
  const high = Math.max(moved, added) * MM;
  for (const [picture, map] of [[left, file], [right, repaired]]) {
    picture.setField({ ofVertex: map.distance.map((d) => (d * MM < LEAST * high ? NaN : d * MM)), low: 0, high });
  }
  const bar = new ColourBar();
  bar.set('Distance', 'mm', { low: 0, high });
  const figure = (picture, title, text) => el('div', {}, el('h3', {}, title), picture.element, paragraph(text, 'note'));
  return section(
    paragraph('The surface of the file had faults. The colour is the distance between the two surfaces; grey: below a hundredth of the scale. Drag to turn both.', 'lead'),
    el('div', { class: 'repair' },
      figure(left, 'File, without removed parts', `At most ${units.length(moved)} from the repaired surface.`),
      figure(right, 'Repaired', `At most ${units.length(added)} from the faces of the file, as in the middle of a filled hole.`),
      bar.element));
}
