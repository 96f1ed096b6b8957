// SPDX-License-Identifier: AGPL-3.0-or-later
// The body with the tool on it. A press on the body places the tool, a drag beside it turns the picture.
import { BodyView } from './body-view.js';
import { HOLE, TOUCHABLE } from './data.js';
import { normalsOf } from './model.js';
import { colour, rgb } from './theme.js';
import { standing, toolMesh } from './tool-mesh.js';
import { add, dot, minus, times, unit } from './vectors.js';

const FINEST = 4;  // halvings of a facet near the tool
const STEP = 6;    // of an arrow key, pixels

/** Natural coordinates of (x, y) in the triangle of the corners a, b, c of `at`, into `out`; false outside of it, and where
 *  it turns away from the viewer. */
function inside(x, y, at, a, b, c, out) {
  const ax = at[3 * a], ay = at[3 * a + 1], bx = at[3 * b], by = at[3 * b + 1], cx = at[3 * c], cy = at[3 * c + 1];
  const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  if (area >= 0) return false;  // y points down: what faces the viewer turns clockwise
  out[0] = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area;
  out[1] = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area;
  out[2] = 1 - out[0] - out[1];
  return !(out[0] < -1e-9 || out[1] < -1e-9 || out[2] < -1e-9);
}

/** The mesh of a tool in plain memory, and room for its points in the picture. */
function drawn({ points, normals, facets }) {
  return { points: Float32Array.from(points.flat()), normals: Float32Array.from(normals.flat()), facets: Uint16Array.from(facets.flat()),
    place: new Float32Array(3), at: new Float32Array(3 * points.length), light: new Float32Array(points.length) };
}

export class TouchView extends BodyView {
  /** tool: toolOf(); hand: {press(spot), drag(spot), lift(), deepen(steps), toggle()}, spot: {point, inward} of the
   *  response surface; without a hand the body is only turned. skinOfPoint: the skin vertex of each point of the model;
   *  without it the skin shows the imprint of the tool. */
  constructor(model, { facing, tool, hand, skinOfPoint = null }) {
    super(model, { facing, onPick: () => {}, describe: () => [] });
    this.tool = tool;
    this.hand = hand;
    this.mesh = toolMesh(tool);
    this.body = drawn(this.mesh);
    this.corner = { at: new Float32Array(9), light: new Float32Array(3) };  // of a piece
    this.vertexAt = new Float32Array(model.vertices.position.length);
    this.skinOfPoint = skinOfPoint;
    this.rest = this.shape;
    this.moved = skinOfPoint && { points: Float32Array.from(model.points), normals: Float32Array.from(model.light) };
    // {tip, axis, force, unit: N of an arrow as long as the body, skin: its vertices as they are pressed, null at rest, still: the
    // skin is as it was}
    this.at = null;
    this.cursor = null;  // the last spot
    this.show = { nodes: false, borders: false, path: false, inclusions: true, flags: false };
    if (hand) this.makeTouchable();
    this.measureFacets();
  }

  makeTouchable() {
    this.canvas.classList.add('touchable');
    this.canvas.setAttribute('aria-label', 'The body to touch. Arrow keys move the tool, the space bar presses and '
      + 'lifts it, page up and page down change the depth, arrow keys with Shift turn the body.');
  }

  /** Middle, reach and outward direction of each facet. */
  measureFacets() {
    const { points, facets, light } = this.model;
    const count = facets.length / 3;
    this.middle = new Float32Array(3 * count);
    this.reach = new Float32Array(count);
    this.outward = new Float32Array(3 * count);
    for (let f = 0; f < count; ++f) {
      const corners = [0, 1, 2].map((i) => 3 * facets[3 * f + i]);
      for (let k = 0; k < 3; ++k) {
        this.middle[3 * f + k] = corners.reduce((sum, p) => sum + points[p + k], 0) / 3;
        this.outward[3 * f + k] = corners.reduce((sum, p) => sum + light[p + k], 0) / 3;
      }
      this.reach[f] = Math.max(...corners.map((p) => Math.hypot(...[0, 1, 2].map((k) => points[p + k] - this.middle[3 * f + k]))));
    }
  }

  place(at) {
    this.at = at;
    this.work.moved = 0;
    if (!at?.still) this.deform(at?.skin);
    this.draw(true);
  }

  /** The points of the picture to their vertices of the skin, three coordinates each. */
  deform(skin) {
    if (!this.moved || !skin) {
      this.shape = this.rest;
      return;
    }
    const { points, normals } = this.moved;
    const { skinOfPoint } = this;
    let moved = 0;
    for (let p = 0, i = 0; p < skinOfPoint.length; ++p, i += 3) {
      const j = 3 * skinOfPoint[p];
      const x = Math.fround(skin[j]), y = Math.fround(skin[j + 1]), z = Math.fround(skin[j + 2]);
      if (x === points[i] && y === points[i + 1] && z === points[i + 2]) continue;
      points[i] = x;
      points[i + 1] = y;
      points[i + 2] = z;
      ++moved;
    }
    this.work.moved = moved;
    if (moved > 0) normalsOf(points, this.model.facets, normals);
    this.shape = this.moved;
  }

  /** Facets that the tool may have pushed in. */
  nearFacets() {
    const near = new Set();
    if (!this.at || this.moved) return near;
    const { axis, tip } = this.at;
    const centre = this.centre();
    const reach = Math.hypot(...minus(tip, centre)) + this.tool.radius + this.tool.length / 2;
    for (let f = 0; f < this.reach.length; ++f) {
      const away = Math.hypot(this.middle[3 * f] - centre[0], this.middle[3 * f + 1] - centre[1], this.middle[3 * f + 2] - centre[2]);
      if (away < reach + this.reach[f] && dot(this.outward.subarray(3 * f, 3 * f + 3), axis) < 0) near.add(f);
    }
    return near;
  }

  centre() { return add(this.at.tip, times(-this.tool.radius, this.at.axis)); }

  leftOut() { return this.near.size > 0 ? this.near : null; }

  fill(at, light) {
    this.near = this.nearFacets();
    super.fill(at, light);
    if (!this.at) return;
    this.projectPoint = this.project(this.raster.width, this.raster.height);
    this.lamp = this.lampDirection();
    this.stand = standing(this.tool, this.at.tip, this.at.axis);
    for (const f of this.near) this.fillImprinted(f, light);
    this.fillTool();
  }

  /** The skin near the tool in small pieces, their corners moved out of the tool along its axis. */
  fillImprinted(f, light) {
    const { points, facets } = this.model;
    const corners = [0, 1, 2].map((i) => {
      const p = facets[3 * f + i];
      return { x: Array.from(points.subarray(3 * p, 3 * p + 3)), light: light[p], t: this.colourOf(f, p) };
    });
    const pieces = Math.max(1, Math.min(2 ** FINEST, Math.ceil((6 * this.reach[f]) / this.tool.radius)));
    const corner = (i, j) => {
      const weights = [1 - (i + j) / pieces, i / pieces, j / pieces];
      const mix = (read) => corners.reduce((sum, c, k) => sum + weights[k] * read(c), 0);
      return this.imprint({ x: [0, 1, 2].map((k) => mix((c) => c.x[k])), light: mix((c) => c.light), t: mix((c) => c.t) });
    };
    const grey = this.greys[this.inGrey[f]];
    for (let i = 0; i < pieces; ++i) {
      for (let j = 0; i + j < pieces; ++j) {
        this.piece(f, [corner(i, j), corner(i + 1, j), corner(i, j + 1)], grey);
        if (i + j + 1 < pieces) this.piece(f, [corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)], grey);
      }
    }
  }

  /** A corner inside the tool moves onto it; there the skin faces the middle of the tool. */
  imprint(corner) {
    const moved = this.mesh.push(corner.x, this.stand);
    if (!moved) return corner;
    return { x: moved.point, light: this.lightOf(dot(this.lamp, moved.normal)), t: corner.t };
  }

  /** Shape before colour: dents are to be seen. */
  lightOf(cosine) { return 0.5 + 0.5 * Math.max(0, cosine); }

  piece(id, corners, grey) {
    const { at, light } = this.corner;
    corners.forEach((c, i) => {
      this.projectPoint(c.x, 0, at, 3 * i);
      light[i] = c.light;
    });
    const [a, b, c] = corners;
    this.raster.triangle(id, at, light, 0, 1, 2, a.t, b.t, c.t, grey);
  }

  fillTool() {
    const { tip, axis, first: u, second: v } = this.stand;
    const { points, normals, facets, place, at, light } = this.body;
    const { lamp } = this;
    const [lampU, lampV, lampAxis] = [dot(lamp, u), dot(lamp, v), dot(lamp, axis)];
    for (let p = 0; p < light.length; ++p) {
      const i = 3 * p;
      for (let k = 0; k < 3; ++k) place[k] = tip[k] + points[i] * u[k] + points[i + 1] * v[k] - points[i + 2] * axis[k];
      this.projectPoint(place, 0, at, i);
      light[p] = this.lightOf(lampU * normals[i] + lampV * normals[i + 1] - lampAxis * normals[i + 2]);
    }
    const grey = rgb('tool');
    for (let i = 0; i < facets.length; i += 3) this.raster.triangle(-1, at, light, facets[i], facets[i + 1], facets[i + 2], 0, 0, 0, grey);
  }

  overlay(context) {
    super.overlay(context);
    if (this.at) this.drawForce(context);
  }

  /** The force of the body on the tool, from the tip. */
  drawForce(context) {
    const { tip, force, unit: full } = this.at;
    const size = Math.hypot(...force);
    if (!(size > 0)) return;
    const project = this.project(this.raster.width, this.raster.height);
    const spot = new Float32Array(6);
    project(tip, 0, spot, 0);
    project(add(tip, times(this.model.radius / full, force)), 0, spot, 3);  // `full` N: half the body
    const [x, y, endX, endY] = [spot[0], spot[1], spot[3], spot[4]];
    const length = Math.hypot(endX - x, endY - y) || 1;
    const head = Math.min(10 * this.scale, length / 2);
    const along = [(endX - x) / length, (endY - y) / length];
    context.lineCap = 'round';
    for (const [style, width] of [['#fff', 6], [colour('series-3'), 3]]) {
      context.strokeStyle = style;
      context.lineWidth = width * this.scale;
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(endX, endY);
      for (const side of [-1, 1]) {
        context.moveTo(endX, endY);
        context.lineTo(endX - head * (along[0] - side * 0.6 * along[1]), endY - head * (along[1] + side * 0.6 * along[0]));
      }
      context.stroke();
    }
  }

  /** The spot of the response surface at a pixel of the canvas, undeformed; null where there is none. */
  spotAt(x, y) {
    const { surface, vertices } = this.model;
    const project = this.project(this.raster.width, this.raster.height);
    const { triangles, library_triangle: own } = surface;
    const { response_status: responds } = vertices;
    const at = this.vertexAt, weights = [0, 0, 0];
    for (let i = 0; i < at.length; i += 3) project(vertices.position, i, at, i);
    let found = null, front = -Infinity;
    for (let t = 0; t < own.length; ++t) {
      const a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
      if (own[t] < 0 || responds[a] === HOLE || responds[b] === HOLE || responds[c] === HOLE) continue;
      if (!inside(x, y, at, a, b, c, weights)) continue;
      const z = weights[0] * at[3 * a + 2] + weights[1] * at[3 * b + 2] + weights[2] * at[3 * c + 2];
      if (z <= front) continue;
      front = z;
      found = { corners: [a, b, c], weights: weights.slice() };
    }
    return found && this.spotOf(found);
  }

  spotOf({ corners, weights }) {
    const { position, inward } = this.model.vertices;
    const mix = (column) => [0, 1, 2].map((k) => corners.reduce((sum, v, i) => sum + weights[i] * column[3 * v + k], 0));
    return { point: mix(position), inward: unit(mix(inward)) };
  }

  spotOfNode(v) { return this.spotOf({ corners: [v], weights: [1] }); }

  pixelOf(event) {
    const box = this.canvas.getBoundingClientRect();
    return [(event.clientX - box.left) * this.scale, (event.clientY - box.top) * this.scale];
  }

  /** The body is pressed where it has responses and is seen, on a finger or the first button. */
  spotUnder(event) {
    const pixel = this.pixelOf(event);
    const facet = this.raster.facetAt(...pixel);
    if (event.button !== 0 || facet < 0 || this.model.surface.facet_kind[facet] !== TOUCHABLE) return null;
    return this.spotAt(...pixel);
  }

  listen() {
    let turning = null, pressing = false, finger = null;
    const { canvas } = this;
    canvas.addEventListener('pointerdown', (e) => {
      if (finger !== null) return;
      finger = e.pointerId;
      canvas.setPointerCapture(e.pointerId);
      const spot = this.hand ? this.spotUnder(e) : null;
      pressing = spot !== null;
      if (pressing) this.press(spot);
      else turning = [e.clientX, e.clientY];
    });
    canvas.addEventListener('pointermove', (e) => {
      if (e.pointerId !== finger) return;
      if (pressing) this.drag(this.spotAt(...this.pixelOf(e)));
      if (!turning) return;
      this.camera.turn(0.008 * (e.clientX - turning[0]), 0.008 * (e.clientY - turning[1]));
      turning = [e.clientX, e.clientY];
      this.draw(true);
    });
    const end = (e) => {
      if (e.pointerId !== finger) return;
      if (pressing) this.hand.lift();
      if (turning) this.draw();
      [turning, pressing, finger] = [null, false, null];
    };
    canvas.addEventListener('pointerup', end);
    canvas.addEventListener('pointercancel', end);
    canvas.addEventListener('wheel', (e) => {
      if (!pressing) return;  // let the page scroll
      e.preventDefault();
      this.hand.deepen(-Math.sign(e.deltaY));
    }, { passive: false });
    canvas.addEventListener('keydown', (e) => this.key(e));
  }

  press(spot) {
    this.cursor = spot;
    this.hand.press(spot);
  }

  drag(spot) {
    if (!spot) return;
    this.cursor = spot;
    this.hand.drag(spot);
  }

  key(event) {
    const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    if (!this.hand || event.shiftKey || ['+', '-', '='].includes(event.key)) return super.key(event);
    if (moves[event.key]) this.walk(moves[event.key]);
    else if (event.key === ' ') this.hand.toggle();
    else if (event.key === 'PageUp' || event.key === 'PageDown') this.hand.deepen(event.key === 'PageUp' ? -1 : 1);
    else return undefined;
    event.preventDefault();
    return undefined;
  }

  /** One step of the tool over the surface, along the screen. */
  walk([right, down]) {
    if (!this.cursor) return;
    const project = this.project(this.raster.width, this.raster.height);
    const spot = new Float32Array(3);
    project(this.cursor.point, 0, spot, 0);
    this.drag(this.spotAt(spot[0] + STEP * this.scale * right, spot[1] + STEP * this.scale * down));
  }
}
