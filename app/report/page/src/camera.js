// SPDX-License-Identifier: AGPL-3.0-or-later
// Parallel projection. rows: unit vectors right, up, toward the viewer.

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / (Math.hypot(...a) || 1));

export class Camera {
  /** z up; the viewer stands on the side that `direction` points to, a little above and beside. */
  constructor(direction) {
    this.zoom = 1;
    const azimuth = Math.atan2(direction[1], direction[0]) + 0.35;
    const rise = Math.asin(Math.max(-1, Math.min(1, unit(direction)[2])));
    const elevation = Math.max(-0.5, Math.min(1.1, rise + 0.2));
    const toward = [Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)];
    const right = unit(cross([0, 0, 1], toward));
    this.rows = [right, cross(toward, right), toward];
  }

  /** Turn about the axes of the screen, in rad. */
  turn(aboutUp, aboutRight) {
    const [right, up, toward] = this.rows;
    const mix = (a, s, b, c) => unit(a.map((x, i) => s * x + c * b[i]));
    const toward1 = mix(toward, Math.cos(aboutUp), right, -Math.sin(aboutUp));
    const right1 = cross(up, toward1);
    const toward2 = mix(toward1, Math.cos(aboutRight), up, Math.sin(aboutRight));
    this.rows = [right1, cross(toward2, right1), toward2];
  }
}
