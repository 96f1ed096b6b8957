// SPDX-License-Identifier: AGPL-3.0-or-later
// Numbers as a reader wants them. The data is SI; a non-breaking space binds number and unit.
const NBSP = '\u00a0';

/** Three significant digits, without an exponent in the everyday range. */
export function significant(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(digits - 1).replace('-', '\u2212');
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return group(value.toFixed(Math.min(decimals, 8)));
}

function group(text) {
  const [whole, fraction] = text.replace('-', '\u2212').split('.');
  const grouped = whole.replace(/\B(?=(\d{3})+$)/g, '\u202f');
  return fraction === undefined ? grouped : `${grouped}.${fraction}`;
}

export const count = (n) => group(String(n));

const NOTHING = 1e-3;  // of the smallest unit: what is less is a rounding error

const scaled = (steps) => (value) => {
  if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
  const [smallest] = steps[steps.length - 1];
  if (Math.abs(value) < NOTHING * smallest) return `0${NBSP}${(steps.find(([f]) => f === 1) ?? steps[0])[1]}`;
  const [factor, unit] = steps.find(([f]) => Math.abs(value) >= f) ?? steps[steps.length - 1];
  return significant(value / factor) + NBSP + unit;
};
/** Steps of units, the largest first, for the axis of a plot. */
export const FORCES = [[1, 'N'], [1e-3, 'mN'], [1e-6, '\u00b5N'], [1e-9, 'nN']];
export const LENGTHS = [[1e-3, 'mm'], [1e-6, '\u00b5m'], [1e-9, 'nm']];
/** The step of the largest of some numbers, in magnitude. Below a tenth of a unit the next one serves. */
export function stepOf(values, steps, least = 1) {
  const largest = values.reduce((most, v) => Math.max(most, Math.abs(v)), 0);
  return steps.find(([f]) => largest >= least * f) ?? steps[steps.length - 1];
}
export const length = (m) => significant(m * 1e3) + NBSP + 'mm';
/** A length in the unit of its size. */
export const scaledLength = (m) => (Math.abs(m) < NOTHING * 1e-9 ? length(0) : Math.abs(m) < 1e-4 ? significant(m * 1e6) + NBSP + '\u00b5m' : length(m));
export const force = scaled(FORCES);
export const pressure = scaled([[1e6, 'MPa'], [1e3, 'kPa'], [1, 'Pa'], [1e-3, 'mPa']]);
export const volume = scaled([[1e-6, 'cm\u00b3'], [1e-9, 'mm\u00b3'], [1e-18, '\u00b5m\u00b3']]);
export const stiffness = (k) => significant(k) + NBSP + 'N/m';
/** Rounded up to four significant digits: an upper bound stays one. */
function roundedUp(value) {
  const unit = 10 ** (Math.floor(Math.log10(value)) - 3);
  return significant(value > 0 ? Math.ceil(value / unit - 1e-9) * unit : value, 4);
}
/** A bound of the certificate: where there is none it reads null or infinite. */
export const bound = (k) => (Number.isFinite(k) ? `${roundedUp(k)}${NBSP}N/m` : 'no bound');
export const lowestRate = (f) => `${roundedUp(f)}${NBSP}Hz`;
/** A position in the unit of the page. */
export const place = (p) => `(${p.map((x) => significant(x * 1e3)).join(', ')})${NBSP}mm`;
const ENERGIES = [[1e-3, 'mJ'], [1e-6, '\u00b5J'], [1e-9, 'nJ'], [1e-12, 'pJ']];
/** {factor, name} of an axis whose largest value is given in SI. */
const axisOf = (steps) => (largest) => {
  const [size, name] = largest ? stepOf([largest], steps, 0.1) : steps[0];
  return { factor: 1 / size, name };
};
export const axis = { force: axisOf(FORCES), length: axisOf(LENGTHS), energy: axisOf(ENERGIES) };
export const energy = scaled([[1, 'J'], [1e-3, 'mJ'], [1e-6, '\u00b5J'], [1e-9, 'nJ'], [1e-12, 'pJ']]);
export const time = scaled([[1, 's'], [1e-3, 'ms'], [1e-6, '\u00b5s'], [1e-9, 'ns']]);
export const frequency = scaled([[1e6, 'MHz'], [1e3, 'kHz'], [1, 'Hz']]);
/** Rounds to a tenth of a per mille. */
export const percent = (x) => (Number.isFinite(x) && x !== 0 && Math.abs(x) < 1e-4
  ? `< 0.01${NBSP}%` : significant(x * 100, 2) + NBSP + '%');
export const bytes = scaled([[1e9, 'GB'], [1e6, 'MB'], [1e3, 'kB'], [1, 'B']]);

export function duration(seconds) {
  if (seconds < 120) return time(seconds);
  const minutes = seconds / 60;
  return minutes < 120 ? significant(minutes) + NBSP + 'min' : significant(minutes / 60) + NBSP + 'h';
}
