// SPDX-License-Identifier: AGPL-3.0-or-later
// The embedded data: plain JSON whose columns are {"f4" | "i4" | "u4" | "u2" | "u1": base64}.
const ARRAYS = { f4: Float32Array, i4: Int32Array, u4: Uint32Array, u2: Uint16Array, u1: Uint8Array };

export function decode(value) {
  if (Array.isArray(value)) return value.map(decode);
  if (value === null || typeof value !== 'object') return value;
  const keys = Object.keys(value);
  if (keys.length === 1 && ARRAYS[keys[0]] && typeof value[keys[0]] === 'string') {
    const bytes = Uint8Array.from(atob(value[keys[0]]), (c) => c.charCodeAt(0));
    return new ARRAYS[keys[0]](bytes.buffer);
  }
  return Object.fromEntries(keys.map((k) => [k, decode(value[k])]));
}

export const readData = () => decode(JSON.parse(document.getElementById('data').textContent));

export const RESPONSE = ['fitted', 'interpolated from its neighbours', 'none (hole)'];
export const SITE = { 0: 'complete', 1: 'partial', 2: 'failed', 255: 'not run' };
export const HOLE = 2;
export const TOUCHABLE = 0;
export const FIXED = 2;
