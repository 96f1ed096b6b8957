// SPDX-License-Identifier: AGPL-3.0-or-later
// The end of a tool, to scale, and the skin that it moves. Local coordinates: the tip is the origin, the third axis
// points out of the body, along the shaft.
import { add, dot, minus, times, unit } from './vectors.js';

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

const discProfile = (radius) => [
  { r: 0, z: 0, n: [0, -1] }, { r: radius, z: 0, n: [0, -1] }, { r: radius, z: 0, n: [1, 0] }];

function shaft(radius) {
  const end = SHAFT * radius;
  return [{ r: radius, z: end, n: [1, 0] }, { r: radius, z: end, n: [0, 1] }, { r: 0, z: end, n: [0, 1] }];
}

/** A point inside of the sphere moves along the axis onto its front. */
function pushOutOfSphere(radius) {
  return (x, tip, axis) => {
    const centre = add(tip, times(-radius, axis));
    const from = minus(x, centre);
    const away = dot(from, from);
    const along = dot(from, axis);
    const across = away - along * along;
    if (across >= radius * radius) return null;
    const front = Math.sqrt(radius * radius - across);
    if (along >= front || along < -SHAFT * radius) return null;
    const point = add(x, times(front - along, axis));
    return { point, normal: unit(minus(centre, point)) };
  };
}

function pushOutOfDisc(radius) {
  return (x, tip, axis) => {
    const from = minus(x, tip);
    const along = dot(from, axis);
    const across = dot(from, from) - along * along;
    if (across >= radius * radius || along >= 0 || along < -SHAFT * radius) return null;
    return { point: add(x, times(-along, axis)), normal: times(-1, axis) };
  };
}

/** {points, normals, facets, push(x, tip, axis)}; push gives {point, normal of the skin there}, or null outside. */
export function toolMesh(shape, radius) {
  const disc = shape === 'disc';
  const profile = [...(disc ? discProfile(radius) : sphereProfile(radius)), ...shaft(radius)];
  return { ...revolved(profile), push: disc ? pushOutOfDisc(radius) : pushOutOfSphere(radius) };
}
