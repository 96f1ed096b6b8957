// SPDX-License-Identifier: AGPL-3.0-or-later
// The runtime of the page with the library and the skin of the report, for all pictures of it.
import { Runtime } from './runtime.js';

const bytesOf = (column) => new Uint8Array(column.buffer, column.byteOffset, column.byteLength);
const loaded = new WeakMap();

/** {runtime, library, skin: null where the report has no deformation, skinOfPoint}; null where the report has no runtime. */
export function touchable(data) {
  if (!data.touch) return null;
  if (!loaded.has(data)) {
    const runtime = new Runtime(bytesOf(data.touch.runtime));
    const library = runtime.load(bytesOf(data.touch.library));
    const file = data.touch.skin?.file;
    loaded.set(data, { runtime, library, skin: file ? runtime.loadSkin(library, bytesOf(file)) : null, skinOfPoint: file ? data.touch.skin.of_point : null });
  }
  return loaded.get(data);
}

/** Wavefront OBJ of the skin, m. */
export function objOf(skin, positions) {
  const lines = [];
  for (let i = 0; i < positions.length; i += 3) lines.push(`v ${positions[i]} ${positions[i + 1]} ${positions[i + 2]}`);
  const triangles = skin.facets();
  for (let t = 0; t < triangles.length; t += 3) lines.push(`f ${triangles[t] + 1} ${triangles[t + 1] + 1} ${triangles[t + 2] + 1}`);
  return lines.join('\n') + '\n';
}
