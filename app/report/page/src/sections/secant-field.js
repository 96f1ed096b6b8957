// SPDX-License-Identifier: AGPL-3.0-or-later
import { firstRange, rangeOf } from '../colour-range.js';
import { secantStiffness } from '../response.js';

/** The colours of a body that is touched: the secant stiffness over the whole depth. */
export function secantField(data) {
  const size = data.vertices.response_status.length;
  const depth = data.key.depth || 1e-3;
  const ofVertex = Float32Array.from({ length: size }, (_, v) => secantStiffness(data.normal, v, depth));
  return { ofVertex, ...(rangeOf(ofVertex, firstRange(ofVertex)) ?? { low: 0, high: 1 }) };
}
