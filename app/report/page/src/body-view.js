// SPDX-License-Identifier: AGPL-3.0-or-later
// The turning picture of the body: colours, nodes, contact path, hovering and clicking.
import { drawAxes, drawScaleBar } from './annotations.js';
import { Camera } from './camera.js';
import { inRange } from './colour-range.js';
import { viridis } from './colormap.js';
import { FIXED, HOLE, TOUCHABLE } from './data.js';
import { el } from './dom.js';
import { Raster } from './raster.js';
import { colour, onThemeChange, rgb } from './theme.js';
import { significant } from './units.js';

const MAX_PIXELS = 3.2e6;
const DISC = 8;          // radius, pixels
const FLAG = 5;          // half the size of a symbol, pixels
const MOST_LABELS = 30;  // numbers that can be read side by side

function label(context, text, x, y, scale) {
  context.lineWidth = 3 * scale;
  context.strokeStyle = '#fff';
  context.strokeText(text, x, y);
  context.fillStyle = '#000';
  context.fillText(text, x, y);
}

export class BodyView {
  /** field: {ofVertex | ofTriangle, low, high, log, sparse}; log: colours by the logarithm; sparse: known at some vertices only, those
   *  without known neighbours are drawn as discs; describe(vertex, triangle): lines of the tip. */
  constructor(model, { facing, onPick, describe }) {
    this.model = model;
    this.home = facing;
    this.camera = this.homeCamera();
    this.onPick = onPick;
    this.describe = describe;
    this.raster = new Raster();
    const size = model.points.length / 3;
    this.pixels = new Float32Array(3 * size);  // of the points
    this.lights = new Float32Array(size);
    // What the last draw did, and since the start its count and that of canvases made anew: for tests and profiles.
    this.work = { draws: 0, points: 0, facets: 0, resized: 0 };
    this.shape = { points: model.points, normals: model.light };  // as drawn
    this.marked = [];
    this.discs = [];
    this.path = null;
    this.show = { nodes: true, borders: true, path: true, inclusions: true, flags: true };
    this.flags = [];  // {vertex, symbol: 'cross' | 'triangle'}
    this.inclusions = [];  // Outlines
    this.canvas = el('canvas', { tabindex: '0', role: 'img', 'aria-label': 'The body in three dimensions. Arrow keys turn it.' });
    this.tip = el('div', { class: 'tip' });
    this.element = el('div', { class: 'stage' }, this.canvas, this.tip);
    this.canvas.work = this.work;
    this.buffer = document.createElement('canvas');
    this.listen();
    onThemeChange(() => this.draw());
    new ResizeObserver(() => requestAnimationFrame(() => this.draw())).observe(this.canvas);
  }

  setField(field) {
    this.field = field;
    const { model } = this;
    this.pointValue = !field.ofVertex ? null
      : field.sparse ? model.interpolateWithin(field.ofVertex) : model.interpolate(field.ofVertex);
    const known = this.pointValue ?? field.ofTriangle;
    this.coordinate = Float32Array.from(known, (value) => inRange(field, value));  // of each point or triangle, in the colours
    this.inGrey = this.greysOfFacets();
    this.discs = field.sparse ? model.singles(field.ofVertex) : [];
    this.draw();
  }

  reset() {
    this.camera = this.homeCamera();
    this.draw();
  }

  /** Enlarge what is seen from its short side, but leave room to turn it. */
  homeCamera() {
    const camera = new Camera(this.home);
    const { points, centre, radius } = this.model;
    let reach = 0;
    for (let i = 0; i < points.length; i += 3) {
      for (const row of camera.rows.slice(0, 2)) {
        reach = Math.max(reach, Math.abs(row.reduce((sum, r, k) => sum + r * (points[i + k] - centre[k]), 0)));
      }
    }
    camera.zoom = Math.min(1.4, (0.97 * radius) / (reach || radius));
    return camera;
  }

  pixelsPerMetre(width, height) {
    return (0.5 * Math.min(width, height) * this.camera.zoom) / this.model.radius;
  }

  /** The projection at this raster size. */
  project(width, height) {
    const scale = this.pixelsPerMetre(width, height);
    const { rows } = this.camera;
    const { centre } = this.model;
    return (points, i, out, o) => {
      const x = points[i] - centre[0], y = points[i + 1] - centre[1], z = points[i + 2] - centre[2];
      out[o] = width / 2 + scale * (rows[0][0] * x + rows[0][1] * y + rows[0][2] * z);
      out[o + 1] = height / 2 - scale * (rows[1][0] * x + rows[1][1] * y + rows[1][2] * z);
      out[o + 2] = scale * (rows[2][0] * x + rows[2][1] * y + rows[2][2] * z);
    };
  }

  /** fast: a frame of a movement. It takes the size of the last draw: asking for it would lay out the page. */
  draw(fast = false) {
    if (!fast || !this.box) this.box = this.canvas.getBoundingClientRect();
    const { box } = this;
    if (!this.field || box.width === 0) return;
    ++this.work.draws;
    const ratio = devicePixelRatio || 1;
    const width = Math.round(box.width * ratio), height = Math.round(box.height * ratio);
    // Twice the pixels in each direction smooth the edges; while the body turns once is enough.
    const finer = fast || width * height * 4 > MAX_PIXELS ? 1 : 2;
    this.scale = ratio * finer;
    this.rasterize(width * finer, height * finer);
    this.resize(this.canvas, width, height);
    const context = this.canvas.getContext('2d');
    if (finer === 1) {
      context.putImageData(this.raster.image, 0, 0);
    } else {
      this.resize(this.buffer, width * finer, height * finer);
      this.buffer.getContext('2d').putImageData(this.raster.image, 0, 0);
      context.clearRect(0, 0, width, height);
      context.imageSmoothingQuality = 'high';
      context.drawImage(this.buffer, 0, 0, width, height);
    }
    context.save();
    context.scale(1 / finer, 1 / finer);
    this.overlay(context);
    context.restore();
  }

  /** A canvas that is given its size again is made anew. */
  resize(canvas, width, height) {
    if (canvas.width === width && canvas.height === height) return;
    canvas.width = width;
    canvas.height = height;
    ++this.work.resized;
  }

  rasterize(width, height) {
    const { model, raster, pixels: at, lights: light } = this;
    if (raster.resize(width, height)) ++this.work.resized;
    raster.clear();
    this.projectAll(this.shape.points, this.shape.normals, width, height);
    this.fill(at, light);
    if (!this.show.borders) return;
    const bias = 0.004 * width;
    for (let e = 0; e < model.borders.length; e += 2) {
      const [a, b] = [3 * model.borders[e], 3 * model.borders[e + 1]];
      raster.line(at[a], at[a + 1], at[a + 2], at[b], at[b + 1], at[b + 2], bias, 0.86);
    }
  }

  /** Place and light of all points, as project() has them: one loop without a call, as it runs in each frame. */
  projectAll(points, normals, width, height) {
    const { pixels: at, lights: light } = this;
    const scale = this.pixelsPerMetre(width, height);
    const [[a, b, c], [d, e, f], [g, h, i]] = this.camera.rows;
    const [cx, cy, cz] = this.model.centre;
    const [lx, ly, lz] = this.lampDirection();
    for (let p = 0; p < light.length; ++p) {
      const k = 3 * p;
      const x = points[k] - cx, y = points[k + 1] - cy, z = points[k + 2] - cz;
      at[k] = width / 2 + scale * (a * x + b * y + c * z);
      at[k + 1] = height / 2 - scale * (d * x + e * y + f * z);
      at[k + 2] = scale * (g * x + h * y + i * z);
      light[p] = this.lightOf(lx * normals[k] + ly * normals[k + 1] + lz * normals[k + 2]);
    }
    this.work.points = light.length;
  }

  /** Never so dark that the colour misleads. */
  lightOf(cosine) { return 0.72 + 0.28 * Math.max(0, cosine); }

  /** A lamp at the upper left shoulder of the viewer. */
  lampDirection() {
    const [right, up, toward] = this.camera.rows;
    return toward.map((t, k) => 0.88 * t + 0.36 * up[k] - 0.3 * right[k]);
  }

  fill(at, light) {
    const { raster, work, coordinate, inGrey } = this;
    const { facets, sprung } = this.model;
    this.greys = [null, rgb('body-hole'), Object.assign(rgb('body-fixed'), { hatch: Math.max(2, Math.round(3 * this.scale)) })];
    const springs = Math.max(3, Math.round(5 * this.scale));
    const ofTriangle = this.field.ofTriangle ? this.model.surface.facet_triangle : null;
    const left = this.leftOut();
    work.facets = 0;
    for (let f = 0, i = 0; i < facets.length; ++f, i += 3) {
      const a = facets[i], b = facets[i + 1], c = facets[i + 2];
      if (Raster.isHidden(at, a, b, c) || left?.has(f)) continue;
      const ta = coordinate[ofTriangle ? ofTriangle[f] : a];
      const tb = ofTriangle ? ta : coordinate[b], tc = ofTriangle ? ta : coordinate[c];
      raster.triangle(f, at, light, a, b, c, ta, tb, tc, this.greys[inGrey[f]], sprung[f] ? springs : 0);
      ++work.facets;
    }
  }

  /** Facets that something else draws: a Set, or null. */
  leftOut() { return null; }

  /** Coordinate in the colour map at a point of a facet. */
  colourOf(facet, point) {
    return this.coordinate[this.field.ofTriangle ? this.model.triangleOf(facet) : point];
  }

  /** For each facet the row of `greys`: 0 where the values of its corners are known and it can be touched. */
  greysOfFacets() {
    const { facets, surface } = this.model;
    return Uint8Array.from(surface.facet_kind, (kind, f) => {
      const known = [0, 1, 2].every((i) => Number.isFinite(this.colourOf(f, facets[3 * f + i])));
      return kind === TOUCHABLE && known ? 0 : kind === FIXED ? 2 : 1;
    });
  }

  overlay(context) {
    const project = this.project(this.raster.width, this.raster.height);
    const bias = 0.012 * this.raster.width;
    const spot = new Float32Array(3);
    const place = (points, i) => {
      project(points, i, spot, 0);
      return { x: spot[0], y: spot[1], seen: this.raster.sees(spot[0], spot[1], spot[2], bias) };
    };
    if (this.show.inclusions) this.drawInclusions(context, project);
    if (this.show.nodes) this.drawNodes(context, place);
    if (this.show.flags) this.drawFlags(context, place);
    if (this.show.path && this.path) this.drawPath(context, place);
    for (const mark of this.marked) this.drawMark(context, place, mark);
    this.drawDiscs(context, place);
    this.annotate(context);
  }

  annotate(context) {
    const { width, height } = this.raster;
    const pixelsPerMetre = this.pixelsPerMetre(width, height);
    const length = drawScaleBar(context, { width, height, pixelsPerMetre, scale: this.scale });
    drawAxes(context, { width, height, rows: this.camera.rows, scale: this.scale });
    const bar = `${length} ${(length * pixelsPerMetre) / this.scale}`;  // m and pixels of the page
    if (this.canvas.dataset.bar !== bar) this.canvas.dataset.bar = bar;
  }

  /** Outlines of what lies inside, as if the body were of glass. */
  drawInclusions(context, project) {
    context.lineCap = 'butt';
    const loops = this.inclusions.flatMap((outline) => outline.loops(project));
    for (const [style, width] of [['rgb(0 0 0 / 60%)', 3.4], ['#fff', 1.6]]) {
      context.strokeStyle = style;
      context.lineWidth = width * this.scale;
      context.setLineDash([5 * this.scale, 4 * this.scale]);
      context.beginPath();
      for (const loop of loops) {
        loop.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
        context.closePath();
      }
      context.stroke();
    }
    context.setLineDash([]);
  }

  drawNodes(context, place) {
    const { position, response_status: status } = this.model.vertices;
    context.fillStyle = 'rgb(0 0 0 / 45%)';
    context.beginPath();  // one for all: thousands of fills are slow
    for (let v = 0; v < status.length; ++v) {
      if (status[v] === HOLE) continue;
      const { x, y, seen } = place(position, 3 * v);
      if (!seen) continue;
      context.moveTo(x, y);
      context.arc(x, y, 1.4 * this.scale, 0, 7);
    }
    context.fill();
  }

  /** Symbols at vertices that a reader has to know of; those on the far side are drawn faint. */
  drawFlags(context, place) {
    const r = FLAG * this.scale;
    for (const { vertex, symbol } of this.flags) {
      const { x, y, seen } = place(this.model.vertices.position, 3 * vertex);
      context.globalAlpha = seen ? 1 : 0.25;
      for (const [stroke, width] of [['#fff', 4.5], [colour('warn'), 2.2]]) {
        context.strokeStyle = stroke;
        context.lineWidth = width * this.scale;
        context.beginPath();
        if (symbol === 'cross') {
          for (const side of [-1, 1]) {
            context.moveTo(x - r, y - side * r);
            context.lineTo(x + r, y + side * r);
          }
        } else {
          context.moveTo(x, y - 1.3 * r);
          context.lineTo(x + 1.2 * r, y + 0.9 * r);
          context.lineTo(x - 1.2 * r, y + 0.9 * r);
          context.closePath();
        }
        context.stroke();
      }
    }
    context.globalAlpha = 1;
  }

  /** Single vertices in the colour of their value, and the value itself where there are few. Those
   *  on the far side are left out: a colour seen through the body would be read as one in front. */
  drawDiscs(context, place) {
    const { ofVertex } = this.field;
    const seen = this.discs.map((v) => ({ v, ...place(this.model.vertices.position, 3 * v) })).filter((d) => d.seen);
    context.font = `${12 * this.scale}px system-ui, sans-serif`;
    context.textBaseline = 'middle';
    for (const { v, x, y } of seen) {
      const value = ofVertex[v];
      context.beginPath();
      context.arc(x, y, DISC * this.scale, 0, 7);
      context.fillStyle = `rgb(${viridis(inRange(this.field, value)).map(Math.round).join(' ')})`;
      context.fill();
      for (const [stroke, width] of [['#fff', 3], ['#000', 1]]) {
        context.strokeStyle = stroke;
        context.lineWidth = width * this.scale;
        context.stroke();
      }
      if (seen.length <= MOST_LABELS) label(context, significant(value), x + 1.6 * DISC * this.scale, y, this.scale);
    }
  }

  /** The contact path: pieces on the far side are drawn faint. */
  drawPath(context, place) {
    const { contact, element } = this.path;
    for (const [style, width] of [['#000', 4.5], ['#fff', 2.2]]) {
      for (const front of [false, true]) {
        context.strokeStyle = style;
        context.globalAlpha = front ? 0.95 : 0.12;
        context.lineWidth = width * this.scale;
        context.lineJoin = context.lineCap = 'round';
        context.beginPath();
        let pen = null;
        for (let i = 0; i < element.length; ++i) {
          const here = element[i] < 0 ? null : place(contact, 3 * i);
          if (pen && here && here.seen === front) {
            context.moveTo(pen.x, pen.y);
            context.lineTo(here.x, here.y);
          }
          pen = here;
        }
        context.stroke();
      }
    }
    context.globalAlpha = 1;
  }

  drawMark(context, place, { vertex, style }) {
    if (vertex < 0) return;
    const { x, y, seen } = place(this.model.vertices.position, 3 * vertex);
    context.globalAlpha = seen ? 1 : 0.25;
    for (const [stroke, width, radius] of [['#fff', 4.5, 7], [style ?? colour('ink'), 2.6, 7]]) {
      context.strokeStyle = stroke;
      context.lineWidth = width * this.scale;
      context.beginPath();
      context.arc(x, y, radius * this.scale, 0, 7);
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  /** Node and triangle under a pointer, or null. */
  pick(event) {
    const box = this.canvas.getBoundingClientRect();
    const x = (event.clientX - box.left) * this.scale, y = (event.clientY - box.top) * this.scale;
    const facet = this.raster.facetAt(x, y);
    if (facet < 0) return null;
    const triangle = this.model.triangleOf(facet);
    if (triangle < 0) return null;
    const project = this.project(this.raster.width, this.raster.height);
    const spot = new Float32Array(3);
    let vertex = -1, nearest = Infinity;
    for (const v of this.model.surface.triangles.subarray(3 * triangle, 3 * triangle + 3)) {
      project(this.model.vertices.position, 3 * v, spot, 0);
      const distance = Math.hypot(spot[0] - x, spot[1] - y);
      if (distance < nearest) [nearest, vertex] = [distance, v];
    }
    return { vertex, triangle, facet };
  }

  listen() {
    let last = null, travelled = 0, pending = 0;
    const moving = (on) => this.canvas.classList.toggle('moving', on);
    this.canvas.addEventListener('pointerdown', (e) => {
      last = [e.clientX, e.clientY];
      travelled = 0;
      this.canvas.setPointerCapture(e.pointerId);
    });
    this.canvas.addEventListener('pointermove', (e) => {
      if (!last) return this.hover(e);
      const [dx, dy] = [e.clientX - last[0], e.clientY - last[1]];
      travelled += Math.abs(dx) + Math.abs(dy);
      if (travelled < 4) return undefined;
      last = [e.clientX, e.clientY];
      this.hideTip();
      moving(true);
      this.camera.turn(0.008 * dx, 0.008 * dy);
      cancelAnimationFrame(pending);
      pending = requestAnimationFrame(() => this.draw(true));
      return undefined;
    });
    const end = (e) => {
      if (!last) return;
      last = null;
      moving(false);
      cancelAnimationFrame(pending);
      this.draw();
      const found = e.type === 'pointerup' && travelled < 4 ? this.pick(e) : null;
      if (found) this.onPick(found.vertex);
    };
    this.canvas.addEventListener('pointerup', end);
    this.canvas.addEventListener('pointercancel', end);
    this.canvas.addEventListener('pointerleave', () => this.hideTip());
    this.canvas.addEventListener('wheel', (e) => {
      if (!e.ctrlKey && document.activeElement !== this.canvas) return;  // let the page scroll
      e.preventDefault();
      this.zoomBy(Math.exp(-0.0015 * e.deltaY));
    }, { passive: false });
    this.canvas.addEventListener('keydown', (e) => this.key(e));
  }

  zoomBy(factor) {
    this.camera.zoom = Math.min(12, Math.max(0.5, this.camera.zoom * factor));
    this.draw();
  }

  key(event) {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    if (turns[event.key]) this.camera.turn(...turns[event.key]);
    else if (event.key === '+' || event.key === '=') this.camera.zoom *= 1.15;
    else if (event.key === '-') this.camera.zoom /= 1.15;
    else return;
    event.preventDefault();
    this.draw();
  }

  hover(event) {
    const found = this.pick(event);
    if (!found) return this.hideTip();
    this.tip.replaceChildren(...this.describe(found).map((line) => el('div', {}, line)));
    const box = this.element.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const left = x + 16 + this.tip.offsetWidth > box.width ? x - 16 - this.tip.offsetWidth : x + 16;
    this.tip.style.left = `${Math.max(0, left)}px`;
    this.tip.style.top = `${y + 16}px`;
    this.tip.style.visibility = 'visible';
    return undefined;
  }

  hideTip() {
    this.tip.style.visibility = 'hidden';
  }
}
