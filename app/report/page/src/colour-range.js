// SPDX-License-Identifier: AGPL-3.0-or-later
// Which values the ends of the colours stand for: one stiff node is not to take the whole range.

/** The choices of the reader. */
export const RANGES = { all: 'whole range', middle: '2nd to 98th percentile', log: 'logarithm' };

const LOW = 0.02, HIGH = 0.98;
const DOMINATED = 2;  // a whole range this much wider than the middle hides the differences of most nodes

const known = (values) => Float64Array.from(values).filter(Number.isFinite).sort();
const rank = (sorted, q) => sorted[Math.min(sorted.length - 1, Math.max(0, Math.ceil(q * sorted.length) - 1))];

/** The range that a field begins with. */
export function firstRange(values) {
  const sorted = known(values);
  if (!sorted.length) return 'all';
  const middle = rank(sorted, HIGH) - rank(sorted, LOW);
  return middle > 0 && sorted[sorted.length - 1] - sorted[0] > DOMINATED * middle ? 'middle' : 'all';
}

/** {low, high, log} of the colours; null without a value. */
export function rangeOf(values, mode) {
  const sorted = known(values);
  if (!sorted.length) return null;
  const most = sorted[sorted.length - 1];
  if (mode === 'middle') return { low: rank(sorted, LOW), high: rank(sorted, HIGH), log: false };
  const positive = sorted.find((v) => v > 0);
  return mode === 'log' && positive ? { low: positive, high: most, log: true } : { low: sorted[0], high: most, log: false };
}

/** Coordinate of a value in the colour map: 0 to 1 within the range. */
export function inRange({ low, high, log }, value) {
  if (!log) return (value - low) / (high - low || 1);
  if (Number.isNaN(value)) return NaN;
  return value > 0 ? Math.log(value / low) / (Math.log(high / low) || 1) : 0;
}
