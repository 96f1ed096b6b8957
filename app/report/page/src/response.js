// SPDX-License-Identifier: AGPL-3.0-or-later
// A stored response: the force is piecewise quadratic, its slope piecewise linear between knots, and
// linear with the last slope beyond them (the format page of library.h5 has the formula).

/** Force in N of vertex v at d in m; columns: {offset, knot, slope}. NaN without a response. */
export function responseForce(columns, v, d) {
  const first = columns.offset[v];
  const last = columns.offset[v + 1] - 1;
  if (last <= first) return NaN;
  if (!(d > 0)) return 0;
  let force = 0;
  for (let k = first; k < last; ++k) {
    const h = columns.knot[k + 1] - columns.knot[k];
    const [s0, s1] = [columns.slope[k], columns.slope[k + 1]];
    const t = d - columns.knot[k];
    if (t <= h) return force + s0 * t + ((s1 - s0) * t * t) / (2 * h);
    force += (h * (s0 + s1)) / 2;
  }
  return force + columns.slope[last] * (d - columns.knot[last]);
}

/** f(d)/d, N/m */
export const secantStiffness = (columns, v, d) => responseForce(columns, v, d) / d;

/** Deepest knot of vertex v, m */
export function lastKnot(columns, v) {
  const last = columns.offset[v + 1] - 1;
  return last > columns.offset[v] ? columns.knot[last] : 0;
}
