// SPDX-License-Identifier: AGPL-3.0-or-later
// The outline of a closed surface: the edges between a facet that faces the viewer and one that does not.

export class Outline {
  /** inclusion: {points, facets} of a closed surface, oriented outwards */
  constructor({ points, facets }) {
    this.points = points;
    this.facets = facets;
  }

  /** Closed loops of [x, y] in pixels; project(points, i, out, o) as of BodyView. */
  loops(project) {
    const at = new Float32Array(this.points.length);
    for (let i = 0; i < at.length; i += 3) project(this.points, i, at, i);
    const next = this.frontBorder(at);
    const loops = [];
    while (next.size) {
      const loop = [];
      let [point] = next.keys();
      while (next.has(point)) {
        const ends = next.get(point);
        loop.push([at[3 * point], at[3 * point + 1]]);
        const end = ends.pop();
        if (!ends.length) next.delete(point);
        point = end;
      }
      loops.push(loop);
    }
    return loops;
  }

  /** Directed border edges of the facets that face the viewer: start -> ends. */
  frontBorder(at) {
    const { facets } = this;
    const size = at.length / 3;
    const edges = new Set();
    for (let f = 0; f < facets.length; f += 3) {
      const [a, b, c] = [facets[f], facets[f + 1], facets[f + 2]];
      const area = (at[3 * b] - at[3 * a]) * (at[3 * c + 1] - at[3 * a + 1])
        - (at[3 * b + 1] - at[3 * a + 1]) * (at[3 * c] - at[3 * a]);
      if (area >= 0) continue;  // y points down: what faces the viewer turns clockwise
      for (const [u, v] of [[a, b], [b, c], [c, a]]) {
        if (!edges.delete(v * size + u)) edges.add(u * size + v);
      }
    }
    const next = new Map();
    for (const edge of edges) {
      const start = Math.floor(edge / size);
      if (!next.has(start)) next.set(start, []);
      next.get(start).push(edge % size);
    }
    return next;
  }
}
