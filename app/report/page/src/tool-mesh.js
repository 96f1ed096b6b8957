// SPDX-License-Identifier: AGPL-3.0-or-later
// The end of a tool, to scale, and the skin that it moves. Local coordinates: the tip is the origin, the third axis
// points out of the body, along the shaft.
import { across, add, dot, minus, times, unit } from './vectors.js';

const SECTORS = 28, RINGS = 9;
const SHAFT = 5;  // length over radius

/** Rings of a body of revolution: profile of {r, z, n: [radial, axial]} from the tip on. */
function revolved(profile) {
  const points = [], normals = [], facets = [];
  for (const { r, z, n } of profile) {
    for (let j = 0; j < SECTORS; ++j) {
      const [c, s] = [Math.cos((2 * Math.PI * j) / SECTORS), Math.sin((2 * Math.PI * j) / SECTORS)];
      points.push([r * c, r * s, z]);
      normals.push([n[0] * c, n[0] * s, n[1]]);
    }
  }
  for (let i = 0; i + 1 < profile.length; ++i) {
    for (let j = 0; j < SECTORS; ++j) {
      const [a, b] = [i * SECTORS + j, i * SECTORS + (j + 1) % SECTORS];
      facets.push([a, b, b + SECTORS], [a, b + SECTORS, a + SECTORS]);
    }
  }
  return { points, normals, facets };
}

function sphereProfile(radius) {
  const profile = [];
  for (let i = 0; i <= RINGS; ++i) {
    const angle = (Math.PI / 2) * (i / RINGS);
    profile.push({ r: radius * Math.sin(angle), z: radius * (1 - Math.cos(angle)), n: [Math.sin(angle), -Math.cos(angle)] });
  }
  return profile;
}

/** The flat end, and the fillet of its edge. */
function discProfile(radius, edge) {
  const flat = radius - edge;
  const profile = [{ r: 0, z: 0, n: [0, -1] }, { r: flat, z: 0, n: [0, -1] }];
  for (let i = 1; i <= (edge > 0 ? RINGS : 0); ++i) {
    const angle = (Math.PI / 2) * (i / RINGS);
    profile.push({ r: flat + edge * Math.sin(angle), z: edge * (1 - Math.cos(angle)), n: [Math.sin(angle), -Math.cos(angle)] });
  }
  return [...profile, { r: radius, z: edge, n: [1, 0] }];
}

function shaft(radius) {
  const end = SHAFT * radius;
  return [{ r: radius, z: end, n: [1, 0] }, { r: radius, z: end, n: [0, 1] }, { r: 0, z: end, n: [0, 1] }];
}

/** A cylinder with hemispherical ends that lies along the first axis. */
function lyingMesh(radius, length) {
  const end = (side) => sphereProfile(radius).map(({ r, z, n }) => ({ r, z: side * (length / 2 + radius - z), n: [n[0], -side * n[1]] }));
  const { points, normals, facets } = revolved([...end(-1), ...end(1).reverse()]);
  const lie = ([x, y, z], height) => [z, x, y + height];  // a rotation: facets keep their outside
  return { points: points.map((p) => lie(p, radius)), normals: normals.map((n) => lie(n, 0)), facets };
}

/** A point inside of the sphere moves along the axis onto its front. */
function pushOutOfSphere(radius) {
  return (x, { tip, axis }) => {
    const centre = add(tip, times(-radius, axis));
    const from = minus(x, centre);
    const away = dot(from, from);
    const along = dot(from, axis);
    const square = away - along * along;
    if (square >= radius * radius) return null;
    const front = Math.sqrt(radius * radius - square);
    if (along >= front || along < -SHAFT * radius) return null;
    const point = add(x, times(front - along, axis));
    return { point, normal: unit(minus(centre, point)) };
  };
}

function pushOutOfDisc(radius, edge) {
  return (x, { tip, axis }) => {
    const from = minus(x, tip);
    const along = dot(from, axis);
    const out = minus(from, times(along, axis));
    const distance = Math.hypot(...out), beyond = Math.max(0, distance - (radius - edge));
    const front = beyond > 0 ? Math.sqrt(Math.max(0, edge * edge - beyond * beyond)) - edge : 0;
    if (distance >= radius || along >= front || along < -SHAFT * radius) return null;
    const slope = beyond > 0 ? times(-beyond / (edge * distance), out) : [0, 0, 0];
    return { point: add(x, times(front - along, axis)), normal: unit(add(slope, times(-(front + edge || 1), axis))) };
  };
}

function pushOutOfCylinder(radius, length) {
  return (x, { tip, axis, first }) => {
    const from = minus(x, add(tip, times(-radius, axis)));
    const along = dot(from, axis), lengthwise = dot(from, first);
    const nearest = times(Math.max(-length / 2, Math.min(length / 2, lengthwise)), first);
    const out = minus(minus(from, times(along, axis)), nearest);
    const square = dot(out, out);
    if (square >= radius * radius) return null;
    const front = Math.sqrt(radius * radius - square);
    if (along >= front || along < -SHAFT * radius) return null;
    return { point: add(x, times(front - along, axis)), normal: unit(times(-1, add(out, times(front, axis)))) };
  };
}

const SIZES = { m: 1, cm: 1e-2, mm: 1e-3, um: 1e-6, deg: Math.PI / 180, rad: 1 };

/** A key of [tool] in the case that the library was computed for, in m or rad; 0 where the case is not known or has none. */
function ofCase(provenance, name) {
  const step = provenance.find((s) => s.stage === 'precompute');
  const section = step?.resolved_case.split(/^(?=\[)/m).find((text) => text.startsWith('[tool]\n'));
  const found = section?.match(new RegExp(`^${name} = "(\\S+) (\\S+)"$`, 'm'));
  return found ? Number(found[1]) * SIZES[found[2]] : 0;
}

/** The tool of the report, m and rad; for a library alone as its case has it. The azimuth is that of the axis of a cylinder
 *  from the first tangent (fem/mesh/tangent_frame.hpp). */
export const toolOf = ({ key, provenance = [] }) => ({ shape: key.tool_shape, radius: key.tool_radius,
  edge: key.tool_edge_radius ?? ofCase(provenance, 'edge_radius'), length: key.tool_length ?? ofCase(provenance, 'length'),
  azimuth: ofCase(provenance, 'azimuth') });

/** Whether the shape of a tool is drawn, or a sphere of its radius. */
export const isDrawn = ({ shape, length }) => ['sphere', 'disc'].includes(shape) || (shape === 'cylinder' && length > 0);

/** Where a tool stands: its tip, its axis into the body, and two directions across. */
export function standing({ azimuth }, tip, axis) {
  const [u, v] = across(axis);
  const [c, s] = [Math.cos(azimuth), Math.sin(azimuth)];
  return { tip, axis, first: minus(times(c, u), times(s, v)), second: add(times(s, u), times(c, v)) };
}

/** {points, normals, facets, push(x, stand)}; push gives {point, normal of the skin there}, or null outside. */
export function toolMesh({ shape, radius, edge, length }) {
  if (shape === 'disc') return { ...revolved([...discProfile(radius, edge), ...shaft(radius)]), push: pushOutOfDisc(radius, edge) };
  if (shape === 'cylinder' && length > 0) return { ...lyingMesh(radius, length), push: pushOutOfCylinder(radius, length) };
  return { ...revolved([...sphereProfile(radius), ...shaft(radius)]), push: pushOutOfSphere(radius) };
}
