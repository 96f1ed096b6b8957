// SPDX-License-Identifier: AGPL-3.0-or-later
// The body as the view draws it: boundary facets, each on a triangle of the response surface.

/** Unit normal of each point, the mean of its facets by area, into `out`. */
export function normalsOf(points, facets, out) {
  out.fill(0);
  for (let f = 0; f < facets.length; f += 3) {
    const a = 3 * facets[f], b = 3 * facets[f + 1], c = 3 * facets[f + 2];
    const ux = points[b] - points[a], uy = points[b + 1] - points[a + 1], uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a], vy = points[c + 1] - points[a + 1], vz = points[c + 2] - points[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    out[a] += nx; out[a + 1] += ny; out[a + 2] += nz;
    out[b] += nx; out[b + 1] += ny; out[b + 2] += nz;
    out[c] += nx; out[c + 1] += ny; out[c + 2] += nz;
  }
  for (let p = 0; p < out.length; p += 3) {
    const size = Math.sqrt(out[p] * out[p] + out[p + 1] * out[p + 1] + out[p + 2] * out[p + 2]) || 1;
    for (let k = 0; k < 3; ++k) out[p + k] /= size;
  }
  return out;
}

export class Model {
  constructor(data) {
    this.surface = data.surface;
    this.vertices = data.vertices;
    this.points = data.surface.points;
    this.facets = data.surface.facets;
    this.sprung = data.surface.facet_sprung ?? new Uint8Array(this.facets.length / 3);  // 1: on springs
    this.frame();
    this.light = normalsOf(this.points, this.facets, new Float32Array(this.points.length));
    this.borders = this.patchBorders();
  }

  frame() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.points.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], this.points[i]);
      high[i % 3] = Math.max(high[i % 3], this.points[i]);
    }
    this.centre = low.map((x, k) => (x + high[k]) / 2);
    let radius = 0;
    for (let i = 0; i < this.points.length; i += 3) {
      radius = Math.max(radius, Math.hypot(...this.centre.map((c, k) => this.points[i + k] - c)));
    }
    this.radius = radius || 1;
  }

  /** Edges of the boundary between two response triangles: pairs of points. */
  patchBorders() {
    const { facets } = this;
    const size = this.points.length / 3;
    const open = new Map();
    const borders = [];
    for (let f = 0; f < facets.length / 3; ++f) {
      for (let i = 0; i < 3; ++i) {
        const a = facets[3 * f + i], b = facets[3 * f + (i + 1) % 3];
        const key = Math.min(a, b) * size + Math.max(a, b);
        const other = open.get(key);
        if (other === undefined) open.set(key, f);
        else if (this.surface.facet_triangle[f] !== this.surface.facet_triangle[other]) borders.push(a, b);
      }
    }
    return Uint32Array.from(borders);
  }

  /** Value at each boundary point from values at the response vertices; NaN values are ignored. */
  interpolate(ofVertex) {
    const { point_triangle: triangle, point_natural: natural, triangles } = this.surface;
    const out = new Float32Array(triangle.length);
    for (let p = 0; p < out.length; ++p) {
      const first = natural[2 * p] / 65535, second = natural[2 * p + 1] / 65535;
      const weights = [first, second, Math.max(0, 1 - first - second)];
      let sum = 0, weight = 0;
      for (let l = 0; l < 3; ++l) {
        const value = triangle[p] < 0 ? NaN : ofVertex[triangles[3 * triangle[p] + l]];
        if (!Number.isFinite(value)) continue;
        sum += weights[l] * value;
        weight += weights[l];
      }
      out[p] = weight > 1e-4 ? sum / weight : NaN;
    }
    return out;
  }

  /** The same for values at some vertices only: NaN outside of triangles with three known corners. */
  interpolateWithin(ofVertex) {
    const { point_triangle: triangle, point_natural: natural, triangles } = this.surface;
    const out = this.interpolate(ofVertex);
    for (let p = 0; p < out.length; ++p) {
      const first = natural[2 * p] / 65535, second = natural[2 * p + 1] / 65535;
      const weights = [first, second, 1 - first - second];
      for (let l = 0; l < 3; ++l) {
        if (weights[l] > 1e-4 && triangle[p] >= 0 && !Number.isFinite(ofVertex[triangles[3 * triangle[p] + l]])) out[p] = NaN;
      }
    }
    return out;
  }

  /** Vertices with a value, but without a triangle with three known corners. */
  singles(ofVertex) {
    const { triangles } = this.surface;
    const single = new Set();
    ofVertex.forEach((value, v) => { if (Number.isFinite(value)) single.add(v); });
    for (let t = 0; t < triangles.length; t += 3) {
      const corners = triangles.subarray(t, t + 3);
      if (corners.every((v) => Number.isFinite(ofVertex[v]))) corners.forEach((v) => single.delete(v));
    }
    return [...single];
  }

  triangleOf(facet) {
    return this.surface.facet_triangle[facet];
  }
}
