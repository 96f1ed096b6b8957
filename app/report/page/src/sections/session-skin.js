// SPDX-License-Identifier: AGPL-3.0-or-later
// The skin under the tool of a session, and the direction of the tool.
import { objOf, touchable } from '../touchable.js';
import { add, cross, dot, minus, times, unit } from '../vectors.js';

export const row = (column, i) => Array.from(column.subarray(3 * i, 3 * i + 3));

/** Press direction at a point of a triangle of the surface, interpolated as the runtime does. */
export function inwardAt({ surface, vertices }, triangle, point) {
  const corners = surface.triangles.subarray(3 * triangle, 3 * triangle + 3);
  const [a, b, c] = Array.from(corners, (v) => row(vertices.position, v));
  const normal = cross(minus(b, a), minus(c, a));
  const share = (p, q) => Math.max(0, dot(cross(minus(p, point), minus(q, point)), normal) / dot(normal, normal));
  const weights = [share(b, c), share(c, a), share(a, b)];
  return unit(Array.from(corners).reduce((sum, v, i) => add(sum, times(weights[i], row(vertices.inward, v))), [0, 0, 0]));
}

const STICKS = 1e3;  // coefficient of friction of a contact that does not slide

/** The skin at any step of a session: that of a contact at the recorded contact point with the recorded tip. */
export class SessionSkin {
  constructor(data) {
    const { runtime, library, skin, skinOfPoint } = touchable(data) ?? {};
    this.skin = skin ?? null;
    this.ofPoint = skinOfPoint ?? null;
    if (!this.skin) return;
    this.state = runtime.state(library, { friction: STICKS });
    this.clearance = 1e-3 * runtime.describe(library).depth;
  }

  /** null without a contact, or without a deformation. */
  at({ contact, position, element }, axes, i) {
    if (!this.skin || element[i] < 0) return null;
    this.touch(row(contact, i), row(position, i), axes[i]);
    return this.skin.deform(this.state);
  }

  obj(drawn, axes, i) {
    this.state.reset();  // without a contact: at rest
    return objOf(this.skin, this.at(drawn, axes, i) ?? this.skin.deform(this.state));
  }

  /** Through the skin at the contact point, down to the depth of the tip, and sideways. */
  touch(contact, tip, axis) {
    const below = dot(minus(tip, contact), axis);
    this.state.reset();
    for (const depth of [-this.clearance, Math.min(this.clearance, below), below]) this.state.step(add(contact, times(depth, axis)), [0, 0, 0], 1e-3);
    this.state.step(tip, [0, 0, 0], 1e-3);
  }
}
