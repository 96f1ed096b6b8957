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

  draw(fast = false) {
    const box = this.canvas.getBoundingClientRect();
    if (!this.field || box.width === 0) return;
    const ratio = devicePixelRatio || 1;
    const width = Math.round(box.width * ratio), height = Math.round(box.height * ratio);
    // Twice the pixels in each direction smooth the edges; while the body turns once is enough.
    const finer = fast || width * height * 4 > MAX_PIXELS ? 1 : 2;
    this.scale = ratio * finer;
    this.rasterize(width * finer, height * finer);
    this.canvas.width = width;
    this.canvas.height = height;
    this.buffer.width = width * finer;
    this.buffer.height = height * finer;
    this.buffer.getContext('2d').putImageData(this.raster.image, 0, 0);
    const context = this.canvas.getContext('2d');
    context.imageSmoothingQuality = 'high';
    context.drawImage(this.buffer, 0, 0, width, height);
    context.setTransform(1 / finer, 0, 0, 1 / finer, 0, 0);
    this.overlay(context);
  }

  rasterize(width, height) {
    const { model, raster } = this;
    raster.resize(width, height);
    raster.clear();
    const size = model.points.length / 3;
    const at = new Float32Array(3 * size), light = new Float32Array(size);
    const project = this.project(width, height);
    const lamp = this.lampDirection();
    const { points, normals } = this.shape;
    for (let p = 0; p < size; ++p) {
      project(points, 3 * p, at, 3 * p);
      const n = 3 * p;
      const cosine = lamp[0] * normals[n] + lamp[1] * normals[n + 1] + lamp[2] * normals[n + 2];
      light[p] = this.lightOf(cosine);
    }
    this.fill(at, light);
    if (!this.show.borders) return;
    const bias = 0.004 * width;
    for (let e = 0; e < model.borders.length; e += 2) {
      const [a, b] = [3 * model.borders[e], 3 * model.borders[e + 1]];
      raster.line(at[a], at[a + 1], at[a + 2], at[b], at[b + 1], at[b + 2], bias, 0.86);
    }
  }

  /** Never so dark that the colour misleads. */
  lightOf(cosine) { return 0.72 + 0.28 * Math.max(0, cosine); }

  /** A lamp at the upper left shoulder of the viewer. */
  lampDirection() {
    const [right, up, toward] = this.camera.rows;
    return toward.map((t, k) => 0.88 * t + 0.36 * up[k] - 0.3 * right[k]);
  }

  fill(at, light) {
    const { model, raster } = this;
    const { facets, sprung } = model;
    this.greys = { hole: rgb('body-hole'), fixed: Object.assign(rgb('body-fixed'), { hatch: Math.max(2, Math.round(3 * this.scale)) }) };
    const springs = Math.max(3, Math.round(5 * this.scale));
    const p = new Float32Array(9), shade = new Float32Array(3), t = new Float32Array(3);
    for (let f = 0; f < facets.length / 3; ++f) {
      if (!this.draws(f)) continue;
      for (let i = 0; i < 3; ++i) {
        const v = facets[3 * f + i];
        for (let k = 0; k < 3; ++k) p[3 * i + k] = at[3 * v + k];
        shade[i] = light[v];
        t[i] = this.colourOf(f, v);
      }
      raster.triangle(f, p, shade, t, this.greyOf(f, t), sprung[f] ? springs : 0);
    }
  }

  draws() { return true; }

  /** Coordinate in the colour map at a point of a facet. */
  colourOf(facet, point) {
    return this.coordinate[this.field.ofTriangle ? this.model.triangleOf(facet) : point];
  }

  /** The grey of a facet whose values t are not all known, else null. */
  greyOf(facet, t) {
    const kind = this.model.surface.facet_kind[facet];
    if (kind === TOUCHABLE && Number.isFinite(t[0] + t[1] + t[2])) return null;
    return kind === FIXED ? this.greys.fixed : this.greys.hole;
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
    this.canvas.dataset.bar = `${length} ${(length * pixelsPerMetre) / this.scale}`;  // m and pixels of the page
  }

  /** Outlines of what lies inside, as if the body were of glass. */
  drawInclusions(context, project) {
    context.lineCap = 'butt';
    for (const [style, width] of [['rgb(0 0 0 / 60%)', 3.4], ['#fff', 1.6]]) {
      context.strokeStyle = style;
      context.lineWidth = width * this.scale;
      context.setLineDash([5 * this.scale, 4 * this.scale]);
      for (const outline of this.inclusions) {
        context.beginPath();
        for (const loop of outline.loops(project)) {
          loop.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
          context.closePath();
        }
        context.stroke();
      }
    }
    context.setLineDash([]);
  }

  drawNodes(context, place) {
    const { position, response_status: status } = this.model.vertices;
    context.fillStyle = 'rgb(0 0 0 / 45%)';
    for (let v = 0; v < status.length; ++v) {
      if (status[v] === HOLE) continue;
      const { x, y, seen } = place(position, 3 * v);
      if (!seen) continue;
      context.beginPath();
      context.arc(x, y, 1.4 * this.scale, 0, 7);
      context.fill();
    }
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
