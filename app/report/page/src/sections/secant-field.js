// SPDX-License-Identifier: AGPL-3.0-or-later
import { secantStiffness } from '../response.js';

/** The colours of a body that is touched: the secant stiffness over the whole depth. */
export function secantField(data) {
  const size = data.vertices.response_status.length;
  const depth = data.key.depth || 1e-3;
  const ofVertex = Float32Array.from({ length: size }, (_, v) => secantStiffness(data.normal, v, depth));
  const known = ofVertex.filter(Number.isFinite);
  return { ofVertex, low: known.reduce((a, b) => Math.min(a, b), Infinity), high: known.reduce((a, b) => Math.max(a, b), -Infinity) };
}
