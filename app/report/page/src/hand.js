// SPDX-License-Identifier: AGPL-3.0-or-later
// The hand that moves the tool: it follows the pointer smoothly, and the runtime steps at 1 kHz under it.
import { BEYOND_DEPTH } from './runtime.js';
import { add, minus, times, unit } from './vectors.js';

export const DT = 1e-3;          // s
const FOLLOW = 0.025;            // s, in which the tool covers most of the way to the pointer
const PRESS = 0.25;              // s, for the whole depth
const CLEARANCE = 0.25;          // of the depth: how far above the body the tool waits
const LONGEST_FRAME = 0.05;      // s; time that the browser withheld is not made up for
export const MOST_STEPS = 120000;  // of the record
const NEAR = 1e-4;               // of the depth: then the tool has arrived

/** s: a step in which tissue does not relax. */
const NO_TIME = 1e-12;

/** Where each number of a step of the record stands. */
export const COLUMNS = ['time_s', 'x_m', 'y_m', 'z_m', 'force_x_N', 'force_y_N', 'force_z_N', 'depth_m', 'lateral_m',
  'energy_J', 'tank_J', 'absorbed_J', 'dissipated_J', 'relaxed_fraction', 'status'];

export class Hand {
  /** state: of the runtime. depth: m, deepest press. twin: where tissue relaxes, a second state that goes along without
   *  relaxing, else null. */
  constructor(state, depth, twin = null) {
    this.state = state;
    this.twin = twin;
    this.elastic = false;  // the tissue is not to relax
    this.deepest = depth;
    this.depth = depth / 2;
    this.clear();
  }

  clear() {
    this.state.reset();
    this.twin?.reset();
    this.record = [];
    this.time = 0;
    this.least = Infinity;  // J, of absorbed - stored - tank
    this.spot = this.target = null;
    this.pressed = false;
    this.height = -CLEARANCE * this.deepest;
    this.seen = this.force = this.elasticSeen = null;
  }

  press(spot) {
    if (!this.spot || !this.pressed && !this.touching()) {
      this.spot = { ...spot };
      this.height = -CLEARANCE * this.deepest;
    }
    this.target = spot;
    this.pressed = true;
  }

  drag(spot) {
    if (!this.spot) this.spot = { ...spot };
    this.target = spot;
  }

  lift() { this.pressed = false; }

  touching() { return this.seen !== null && this.seen.element >= 0; }

  /** Where the tip is to go, m below the undeformed skin. */
  goal() { return this.pressed ? this.depth : -CLEARANCE * this.deepest; }

  resting() {
    if (!this.spot) return true;
    const still = Math.abs(this.goal() - this.height) < NEAR * this.deepest;
    return still && Math.hypot(...minus(this.target.point, this.spot.point)) < NEAR * this.deepest;
  }

  tip() { return add(this.spot.point, times(this.height, this.spot.inward)); }

  /** The steps of one frame of the browser. */
  advance(seconds) {
    if (!this.spot) return;
    const steps = Math.round(Math.min(seconds, LONGEST_FRAME) / DT);
    for (let i = 0; i < steps; ++i) this.step();
  }

  step() {
    const part = 1 - Math.exp(-DT / FOLLOW);
    const before = this.tip();
    const most = (this.deepest / PRESS) * DT;
    const way = part * (this.goal() - this.height);
    this.height += Math.max(-most, Math.min(most, way));
    const mix = (a, b) => add(a, times(part, minus(b, a)));
    this.spot.point = mix(this.spot.point, this.target.point);
    this.spot.inward = unit(mix(this.spot.inward, this.target.inward));
    const tip = this.tip();
    const velocity = times(1 / DT, minus(tip, before));
    const { status, force } = this.state.step(tip, velocity, this.elastic ? NO_TIME : DT);
    this.seen = this.state.observe();
    if (this.twin) {
      this.twin.step(tip, velocity, NO_TIME);
      this.elasticSeen = this.twin.observe();
    }
    this.force = force;
    this.time += DT;
    this.account(tip, status);
  }

  account(tip, status) {
    const { seen, force } = this;
    this.beyond = (status & BEYOND_DEPTH) !== 0;
    this.least = Math.min(this.least, seen.absorbed - seen.energy - seen.tank);
    if (this.record.length < MOST_STEPS) this.record.push([this.time, ...tip, ...force, seen.depth, seen.lateral, seen.energy, seen.tank, seen.absorbed,
      seen.dissipated, seen.relaxedFraction, status]);
  }

  csv() {
    return [COLUMNS.join(','), ...this.record.map((row) => row.join(','))].join('\n') + '\n';
  }
}
