// SPDX-License-Identifier: AGPL-3.0-or-later
// Viridis: perceptually uniform, monotone in lightness, safe for colour-blind readers and in print.
const STOPS = [
  [68, 1, 84], [72, 26, 108], [71, 47, 125], [65, 68, 135], [57, 86, 140], [49, 104, 142],
  [42, 120, 142], [35, 136, 142], [31, 152, 139], [34, 168, 132], [53, 183, 121], [84, 197, 104],
  [122, 209, 81], [165, 219, 54], [210, 226, 27], [253, 231, 37],
];

/** [r, g, b] in 0..255 at t in 0..1 */
export function viridis(t) {
  const x = Math.min(1, Math.max(0, t)) * (STOPS.length - 1);
  const i = Math.min(STOPS.length - 2, Math.floor(x));
  return STOPS[i].map((c, k) => c + (x - i) * (STOPS[i + 1][k] - c));
}

export const cssGradient = () =>
  `linear-gradient(to top, ${STOPS.map((c) => `rgb(${c.join(' ')})`).join(', ')})`;

/** 256 x 3 table */
export const TABLE = Float32Array.from({ length: 768 }, (_, i) =>
  viridis(Math.floor(i / 3) / 255)[i % 3]);

/** About n round numbers inside [low, high]. */
export function roundTicks(low, high, n = 5) {
  const span = high - low;
  if (!(span > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(span / n));
  const step = [1, 2, 2.5, 5, 10].map((m) => m * power).find((s) => span / s <= n);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; ++k) ticks.push(k * step);
  return ticks;
}

/** 1, 2 and 5 times powers of ten inside [low, high], low > 0; fewer over many decades, the ends where there are none. */
export function logTicks(low, high) {
  const decades = Math.log10(high / low);
  const steps = decades > 3 ? [1] : [1, 2, 5];
  const ticks = [];
  for (let k = Math.floor(Math.log10(low)); 10 ** k <= high; ++k) {
    for (const m of steps) if (m * 10 ** k >= low && m * 10 ** k <= high) ticks.push(m * 10 ** k);
  }
  return ticks.length > 1 ? ticks : [low, high];
}
