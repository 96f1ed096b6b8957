// SPDX-License-Identifier: AGPL-3.0-or-later
// The embedded data: plain JSON whose columns are {"f4" | "i4" | "u4" | "u2" | "u1": base64}, or {"z1": base64} for bytes that
// are compressed by zlib.
const ARRAYS = { f4: Float32Array, i4: Int32Array, u4: Uint32Array, u2: Uint16Array, u1: Uint8Array };
const PACKED = 'z1';

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

async function unpacked(bytes) {
  const stream = new Response(bytes).body.pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** waiting: takes a promise for each packed column, which is in its place when the promise is kept. */
function decoded(value, waiting) {
  if (Array.isArray(value)) return value.map((part) => decoded(part, waiting));
  if (value === null || typeof value !== 'object') return value;
  const keys = Object.keys(value);
  if (keys.length === 1 && ARRAYS[keys[0]] && typeof value[keys[0]] === 'string') return new ARRAYS[keys[0]](bytesOf(value[keys[0]]).buffer);
  const out = {};
  for (const key of keys) {
    const packed = value[key]?.[PACKED];
    if (typeof packed === 'string') waiting.push(unpacked(bytesOf(packed)).then((bytes) => { out[key] = bytes; }));
    else out[key] = decoded(value[key], waiting);
  }
  return out;
}

export async function readData() {
  const waiting = [];
  const data = decoded(JSON.parse(document.getElementById('data').textContent), waiting);
  await Promise.all(waiting);
  return data;
}

export const RESPONSE = ['fitted', 'interpolated from its neighbours', 'none (hole)'];
export const SITE = { 0: 'complete', 1: 'partial', 2: 'failed', 255: 'not run' };
export const HOLE = 2;
export const TOUCHABLE = 0;
export const FIXED = 2;
