// SPDX-License-Identifier: AGPL-3.0-or-later
// Vectors of three components.
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (s, a) => [s * a[0], s * a[1], s * a[2]];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a) => times(1 / (Math.hypot(...a) || 1), a);

/** Two unit vectors across a unit vector, right-handed with it pointing away: u x v = -axis. */
export function across(axis) {
  const least = [0, 1, 2].reduce((k, i) => (Math.abs(axis[i]) < Math.abs(axis[k]) ? i : k), 0);
  const u = unit(cross(axis, [0, 1, 2].map((k) => (k === least ? 1 : 0))));
  return [u, cross(u, axis)];
}
