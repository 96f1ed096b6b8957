// SPDX-License-Identifier: AGPL-3.0-or-later
// The force in the plane of normal and lateral force, and the friction cone that it cannot leave.
import * as units from '../units.js';

const WIDTH = 220, HEIGHT = 150, LEFT = 12, BASE = 132;  // user units
const NAMESPACE = 'http://www.w3.org/2000/svg';

function svg(tag, attributes, text) {
  const node = document.createElementNS(NAMESPACE, tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  return node;
}

export class FrictionCone {
  constructor(friction) {
    this.full = 0;
    const top = BASE - 118;
    const reach = Math.min(WIDTH - LEFT - 8, friction * 118);
    const high = friction > 0 ? BASE - reach / friction : top;
    this.force = svg('line', { class: 'force', x1: LEFT, y1: BASE, x2: LEFT, y2: BASE });
    this.head = svg('circle', { class: 'head', r: 4, cx: LEFT, cy: BASE });
    this.scale = svg('text', { x: LEFT + 6, y: 11 });
    this.element = svg('svg', { class: 'cone', viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img', 'aria-label': 'The force and the friction cone' });
    this.element.append(
      svg('path', { class: 'inside', d: `M${LEFT} ${BASE}L${LEFT} ${top}L${LEFT + reach} ${top}L${LEFT + reach} ${high}Z` }),
      svg('line', { class: 'edge', x1: LEFT, y1: BASE, x2: LEFT + reach, y2: high }),
      svg('line', { class: 'axis', x1: LEFT, y1: BASE, x2: WIDTH, y2: BASE }),
      svg('line', { class: 'axis', x1: LEFT, y1: BASE, x2: LEFT, y2: 0 }),
      svg('text', { x: WIDTH - 2, y: HEIGHT - 5, 'text-anchor': 'end' }, 'lateral force'),
      this.scale, this.force, this.head);
  }

  /** N. The scale grows with the largest force. */
  show(normal, lateral) {
    this.full = Math.max(this.full, normal, 1e-9);
    const factor = 108 / this.full;
    const [x, y] = [Math.min(WIDTH - 4, LEFT + factor * lateral), BASE - factor * normal];
    for (const [node, names] of [[this.force, ['x2', 'y2']], [this.head, ['cx', 'cy']]]) {
      node.setAttribute(names[0], x);
      node.setAttribute(names[1], y);
    }
    this.scale.textContent = this.full > 1e-9 ? `normal force, to ${units.force(this.full)}` : 'normal force';
  }
}
