// SPDX-License-Identifier: AGPL-3.0-or-later
// A depth-buffered triangle renderer on plain memory: no WebGL, the same picture on every machine.
import { TABLE } from './colormap.js';

export class Raster {
  resize(width, height) {
    if (this.width === width && this.height === height) return;
    this.width = width;
    this.height = height;
    this.image = new ImageData(width, height);
    this.pixel = new Uint32Array(this.image.data.buffer);
    this.depth = new Float32Array(width * height);
    this.facet = new Int32Array(width * height);
  }

  clear() {
    this.pixel.fill(0);
    this.depth.fill(-Infinity);
    this.facet.fill(-1);
  }

  /**
   * One triangle. p: [x, y, z] of its corners in pixels, z toward the viewer; shade: light of each
   * corner; t: colour-map coordinate of each corner, or grey: [r, g, b], with a property `hatch` in stripes of so many
   * pixels; rows: 0, or pixels between level lines that mark a facet on springs.
   */
  triangle(id, p, shade, t, grey, rows = 0) {
    // Not by destructuring, which is many times slower for typed arrays.
    const ax = p[0], ay = p[1], az = p[2], bx = p[3], by = p[4], bz = p[5], cx = p[6], cy = p[7], cz = p[8];
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area >= 0) return;  // y points down: what faces the viewer turns clockwise
    const x0 = Math.max(0, Math.ceil(Math.min(ax, bx, cx)));
    const x1 = Math.min(this.width - 1, Math.floor(Math.max(ax, bx, cx)));
    const y0 = Math.max(0, Math.ceil(Math.min(ay, by, cy)));
    const y1 = Math.min(this.height - 1, Math.floor(Math.max(ay, by, cy)));
    // Natural coordinates are linear in the pixel: value at the row start, and a step to the right.
    const stepA = (by - cy) / area, stepB = (cy - ay) / area;
    for (let y = y0; y <= y1; ++y) {
      let a = ((bx - x0) * (cy - y) - (by - y) * (cx - x0)) / area;
      let b = ((cx - x0) * (ay - y) - (cy - y) * (ax - x0)) / area;
      for (let x = x0, i = y * this.width + x0; x <= x1; ++x, ++i, a += stepA, b += stepB) {
        const c = 1 - a - b;
        if (a < -1e-6 || b < -1e-6 || c < -1e-6) continue;
        const z = a * az + b * bz + c * cz;
        if (z <= this.depth[i]) continue;
        this.depth[i] = z;
        this.facet[i] = id;
        const lit = a * shade[0] + b * shade[1] + c * shade[2];
        const light = rows > 0 && y % rows < rows / 5 ? 0.62 * lit : lit;
        if (grey) {
          const shown = grey.hatch && Math.floor((x + y) / grey.hatch) % 3 === 0 ? 0.72 * light : light;
          this.pixel[i] = pack(grey[0] * shown, grey[1] * shown, grey[2] * shown);
        } else {
          const k = 3 * Math.max(0, Math.min(255, Math.round(255 * (a * t[0] + b * t[1] + c * t[2]))));
          this.pixel[i] = pack(TABLE[k] * light, TABLE[k + 1] * light, TABLE[k + 2] * light);
        }
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

const pack = (r, g, b) => (0xff000000 | (Math.min(255, b) << 16) | (Math.min(255, g) << 8) | Math.min(255, r)) >>> 0;
