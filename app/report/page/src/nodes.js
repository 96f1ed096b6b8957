// SPDX-License-Identifier: AGPL-3.0-or-later
// The nodes whose curves are shown: four by rank, and those that the reader clicked.
import { secantStiffness } from './response.js';

const ROLES = [['softest', 'softest', 'series-1'], ['median', 'median', 'series-2'],
  ['stiffest', 'stiffest', 'series-3'], ['worst_fit', 'worst fit', 'series-4']];
const PICKED = ['series-5', 'series-6'];

export class Nodes {
  constructor(data) {
    this.listeners = [];
    this.picked = [];
    this.fixed = [];
    for (const [key, role, colour] of ROLES) {
      const vertex = data.chosen[key];
      const same = this.fixed.find((n) => n.vertex === vertex);
      if (vertex < 0) continue;
      if (same) same.role += `, ${role}`;
      else this.fixed.push({ vertex, role, colour });
    }
    const depth = data.key.depth;
    this.stiffest = data.chosen.stiffest;
    this.softestValue = this.stiffest < 0 ? NaN : secantStiffness(data.normal, data.chosen.softest, depth);
    this.stiffestValue = this.stiffest < 0 ? NaN : secantStiffness(data.normal, this.stiffest, depth);
    this.size = data.vertices.response_status.length;
  }

  shown() {
    return [...this.fixed, ...this.picked];
  }

  onChange(listener) {
    this.listeners.push(listener);
  }

  /** Show one more node; the older of two picked ones gives way. */
  pick(vertex) {
    if (!(vertex >= 0 && vertex < this.size) || this.shown().some((n) => n.vertex === vertex)) return;
    const free = PICKED.find((c) => !this.picked.some((n) => n.colour === c)) ?? this.picked.shift().colour;
    this.picked.push({ vertex, role: 'chosen', colour: free });
    this.listeners.forEach((f) => f());
  }

  drop(vertex) {
    this.picked = this.picked.filter((n) => n.vertex !== vertex);
    this.listeners.forEach((f) => f());
  }
}
