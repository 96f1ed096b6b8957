// SPDX-License-Identifier: AGPL-3.0-or-later
// A depth-buffered triangle renderer on plain memory: no WebGL, the same picture on every machine.
import { TABLE } from './colormap.js';

/** 0 .. 255 of a value in 0 .. 1. */
const level = (value) => (value <= 0 ? 0 : value >= 1 ? 255 : (255 * value + 0.5) | 0);

const pack = (r, g, b) => (0xff000000 | (Math.min(255, b) << 16) | (Math.min(255, g) << 8) | Math.min(255, r)) >>> 0;

/** stripe: the sum of the coordinates of the pixel. */
function painted(grey, light, stripe) {
  const shown = grey.hatch && Math.floor(stripe / grey.hatch) % 3 === 0 ? 0.72 * light : light;
  return pack(grey[0] * shown, grey[1] * shown, grey[2] * shown);
}

/** The colours of the map at each light. */
const LIT = Uint32Array.from({ length: 65536 }, (_, i) => {
  const k = 3 * (i >> 8), light = (i & 255) / 255;
  return pack(TABLE[k] * light, TABLE[k + 1] * light, TABLE[k + 2] * light);
});

export class Raster {
  /** @return whether it was of another size */
  resize(width, height) {
    if (this.width === width && this.height === height) return false;
    this.width = width;
    this.height = height;
    this.image = new ImageData(width, height);
    this.pixel = new Uint32Array(this.image.data.buffer);
    this.depth = new Float32Array(width * height);
    this.facet = new Int32Array(width * height);
    return true;
  }

  clear() {
    this.pixel.fill(0);
    this.depth.fill(-Infinity);
    this.facet.fill(-1);
  }

  /** Whether the corners a, b, c of `at` turn away from the viewer. y points down: what faces the viewer turns clockwise. */
  static isHidden(at, a, b, c) {
    const ax = at[3 * a], ay = at[3 * a + 1];
    return (at[3 * b] - ax) * (at[3 * c + 1] - ay) - (at[3 * b + 1] - ay) * (at[3 * c] - ax) >= 0;
  }

  /**
   * The triangle of the corners a, b, c. at: [x, y, z] of all points in pixels, z toward the viewer; light: of all points;
   * ta, tb, tc: colour-map coordinates of the corners, or grey: [r, g, b], with a property `hatch` in stripes of so many
   * pixels; rows: 0, or pixels between level lines that mark a facet on springs.
   */
  triangle(id, at, light, a, b, c, ta, tb, tc, grey = null, rows = 0) {
    const ax = at[3 * a], ay = at[3 * a + 1], bx = at[3 * b], by = at[3 * b + 1], cx = at[3 * c], cy = at[3 * c + 1];
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area >= 0) return;
    // What is interpolated is a plane over the pixels: its value at the corner a and its slopes.
    const abX = (bx - ax) / area, abY = (by - ay) / area, acX = (cx - ax) / area, acY = (cy - ay) / area;
    const az = at[3 * a + 2], zb = at[3 * b + 2] - az, zc = at[3 * c + 2] - az;
    const la = light[a], lb = light[b] - la, lc = light[c] - la;
    const zx = zb * acY - zc * abY, zy = zc * abX - zb * acX;
    const lx = lb * acY - lc * abY, ly = lc * abX - lb * acX;
    const tx = (tb - ta) * acY - (tc - ta) * abY, ty = (tc - ta) * abX - (tb - ta) * acX;
    // Rows are cut by the long edge, from the highest corner to the lowest, and by one of the other two. The edges of
    // neighbours are the same numbers, and their pixels belong to both: there is no gap.
    let hx = ax, hy = ay, mx = bx, my = by, ex = cx, ey = cy, swap;
    if (hy > my) { swap = hx; hx = mx; mx = swap; swap = hy; hy = my; my = swap; }
    if (my > ey) { swap = mx; mx = ex; ex = swap; swap = my; my = ey; ey = swap; }
    if (hy > my) { swap = hx; hx = mx; mx = swap; swap = hy; hy = my; my = swap; }
    const long = (ex - hx) / (ey - hy), upper = (mx - hx) / (my - hy), lower = (ex - mx) / (ey - my);
    const { depth, facet, pixel, width } = this;
    const last = Math.min(this.height - 1, Math.floor(ey));
    for (let y = Math.max(0, Math.ceil(hy)); y <= last; ++y) {
      const one = hx + long * (y - hy);
      const other = y < my ? hx + upper * (y - hy) : my < ey ? mx + lower * (y - my) : mx;
      let x = Math.ceil(one < other ? one : other), end = Math.floor(one < other ? other : one);
      if (x < 0) x = 0;
      if (end >= width) end = width - 1;
      if (x > end) continue;
      const right = x - ax, down = y - ay;
      let z = az + zx * right + zy * down;
      let lit = la + lx * right + ly * down;
      let t = ta + tx * right + ty * down;
      const dim = rows > 0 && y % rows < rows / 5 ? 0.62 : 1;
      for (let i = y * width + x, to = y * width + end; i <= to; ++i, z += zx, lit += lx, t += tx) {
        if (z <= depth[i]) continue;
        depth[i] = z;
        facet[i] = id;
        pixel[i] = grey === null ? LIT[(level(t) << 8) | (255 * dim * lit + 0.5)] : painted(grey, dim * lit, i - y * width + y);
      }
    }
  }

  /** Darken the pixels under a segment where it is not hidden. */
  line(ax, ay, az, bx, by, bz, bias, keep) {
    const steps = Math.ceil(Math.max(Math.abs(bx - ax), Math.abs(by - ay), 1));
    for (let s = 0; s < steps; ++s) {
      const u = s / steps;
      const x = Math.round(ax + u * (bx - ax)), y = Math.round(ay + u * (by - ay));
      if (x < 0 || y < 0 || x >= this.width || y >= this.height) continue;
      const i = y * this.width + x;
      if (az + u * (bz - az) + bias < this.depth[i] || this.facet[i] < 0) continue;
      const c = this.pixel[i];
      this.pixel[i] = pack((c & 255) * keep, ((c >> 8) & 255) * keep, ((c >> 16) & 255) * keep);
    }
  }

  /** Whether a point at depth z would be seen. */
  sees(x, y, z, bias) {
    const [i, j] = [Math.round(x), Math.round(y)];
    if (i < 0 || j < 0 || i >= this.width || j >= this.height) return false;
    return z + bias >= this.depth[j * this.width + i];
  }

  facetAt(x, y) {
    const [i, j] = [Math.round(x), Math.round(y)];
    if (i < 0 || j < 0 || i >= this.width || j >= this.height) return -1;
    return this.facet[j * this.width + i];
  }
}
