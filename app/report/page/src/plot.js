// SPDX-License-Identifier: AGPL-3.0-or-later
// The three kinds of plot of the report on uPlot: curves with markers, histograms, time series.
import uPlot from '../vendor/uplot/uPlot.esm.js';
import { el } from './dom.js';
import { download, downloadCanvas, fileName } from './download.js';
import { colour, onThemeChange } from './theme.js';

const FONT = '12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';

function axis(label, side) {
  return {
    side,
    label,
    labelSize: side === 2 ? 22 : 20,
    size: side === 2 ? 30 : 52,
    gap: 4,
    font: FONT,
    labelFont: FONT,
    stroke: () => colour('muted'),
    grid: { stroke: () => colour('grid'), width: 1 },
    ticks: { stroke: () => colour('rule'), width: 1, size: 4 },
    values: (_, splits) => splits.map((v) => (v === null ? '' : tickText(v))),
  };
}

const tickText = (v) => String(Number(v.toPrecision(6))).replace('-', '\u2212');

const field = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** Columns with their labels; an ordinate that is not known is empty. */
function csv(labels, columns) {
  const rows = Array.from(columns[0], (_, i) => columns.map((column) => column[i] ?? '').join(','));
  return [labels.map(field).join(','), ...rows].join('\n') + '\n';
}

/** A figure that follows the width of its place and the colour scheme. */
function figure(title, options, data, height = 240) {
  const axes = `${options.axes[1].label} over ${options.axes[0].label}`;
  const place = el('div', { role: 'group', 'aria-label': axes });
  let chart = null;
  const labels = () => [options.axes[0].label, ...options.series.slice(1).map((s) => `${s.label}, ${options.axes[1].label}`)];
  const name = fileName(title || options.axes[1].label);
  const element = el('div', { class: 'plot' }, title ? el('h3', {}, title) : null, place,
    el('div', { class: 'take' },
      el('button', { type: 'button', class: 'plain', 'aria-label': `${title || 'Curves'} as CSV`, onclick: () => download(`${name}.csv`, 'text/csv', csv(labels(), data)) }, 'CSV'),
      el('button', { type: 'button', class: 'plain', 'aria-label': `${title || 'Curves'} as PNG`, onclick: () => chart && downloadCanvas(`${name}.png`, chart.ctx.canvas) }, 'PNG')));
  const build = (spec, columns) => {
    chart?.destroy();
    const width = Math.max(240, Math.floor(place.getBoundingClientRect().width) || 480);
    chart = new uPlot({ width, height, pxAlign: 0, ...spec }, columns, place);
  };
  const update = (spec, columns) => {
    [options, data] = [spec, columns];
    if (place.isConnected) build(options, data);
  };
  // Not inside the observer: a new size there would be observed in turn.
  new ResizeObserver(() => requestAnimationFrame(() => {
    const width = Math.floor(place.getBoundingClientRect().width);
    if (width < 40) return;
    if (!chart) build(options, data);
    else if (chart.width !== width) chart.setSize({ width, height });
  })).observe(place);
  onThemeChange(() => chart && build(options, data));  // the keys of the legend too
  return { element, update };
}

const MARKER = 7;  // pixels

const named = (name) => () => (name.startsWith('#') ? name : colour(name));

const polygon = (corners) => (path, x, y, r) => {
  corners.forEach(([right, up], i) => path[i ? 'lineTo' : 'moveTo'](x + right * r, y - up * r));
  path.closePath();
};
/** For readers without colour vision each colour of a series has a marker of its own shape. */
const SYMBOLS = [
  ['\u25cf', (path, x, y, r) => { path.moveTo(x + r, y); path.arc(x, y, r, 0, 2 * Math.PI); }],
  ['\u25a0', polygon([[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]])],
  ['\u25b2', polygon([[-1.1, -0.8], [1.1, -0.8], [0, 1.2]])],
  ['\u25c6', polygon([[-1.2, 0], [0, -1.2], [1.2, 0], [0, 1.2]])],
  ['\u25bc', polygon([[-1.1, 0.8], [1.1, 0.8], [0, -1.2]])],
  ['\u25c0', polygon([[-1.2, 0], [0.8, -1.1], [0.8, 1.1]])],
];
const symbolOf = (name) => SYMBOLS[((Number(name.match(/^series-(\d)$/)?.[1]) || 1) - 1) % SYMBOLS.length];
/** The marker of a colour as a character. */
export const symbol = (name) => symbolOf(name)[0];

/** The markers of a series as uPlot draws them, in pixels of the canvas. */
const markers = (name, size) => (u, series, from, to, indices) => {
  const path = new Path2D(), [, draw] = symbolOf(name);
  const values = u.data[series];
  const put = (i) => {
    if (values[i] !== null && values[i] !== undefined) draw(path, u.valToPos(u.data[0][i], 'x', true), u.valToPos(values[i], 'y', true), (size / 2) * devicePixelRatio);
  };
  if (indices) indices.forEach(put);
  else for (let i = from; i <= to; ++i) put(i);
  return { stroke: path, fill: path, flags: 3 };
};

/** Range from zero to a little above the largest value. */
const fromZero = (_, low, high) => [Math.min(0, low ?? 0), high > 0 ? high * 1.05 : 1];

/** Range of values with a margin. */
const around = (_, low, high) => {
  const margin = 0.04 * (high - low || Math.abs(high) || 1);
  return [low - margin, high + margin];
};

/** Range of values of either sign, zero among them, with a margin. */
const aroundZero = (_, low, high) => {
  const [least, most] = [Math.min(0, low ?? 0), Math.max(0, high ?? 0)];
  const margin = 0.06 * (most - least || 1);
  return [least - margin, most + margin];
};

/**
 * Several curves and markers, each with its own abscissae.
 * sets: [{label, colour, x, y, markers: bool, width, dash, spread}]; every x ascending, later sets on top.
 * spread: half the length of a bar at each sample, NaN for none; the CSV has the ends of the bars.
 * mark: abscissa of a dashed line. signed: ordinates of either sign. tight: abscissas need not show zero.
 */
export function curvePlot(title, xLabel, yLabel, height, { signed = false, tight = false } = {}) {
  const spec = (sets, mark) => ({
    legend: { show: false },
    cursor: { drag: { x: false, y: false }, points: { show: false } },
    scales: { x: { time: false, range: tight ? around : fromZero }, y: { range: signed ? aroundZero : fromZero } },
    axes: [axis(xLabel, 2), axis(yLabel, 3)],
    series: [{}, ...sets.map((s) => ({
      label: s.label,
      stroke: named(s.colour),
      width: s.markers ? 0 : s.width ?? 2,
      dash: s.dash,
      pxAlign: 0,
      spanGaps: true,
      paths: s.markers || s.hidden ? () => null : uPlot.paths.linear(),
      points: s.markers
        ? { show: true, size: MARKER, width: 1.5, stroke: named(s.colour), fill: named('paper'), paths: markers(s.colour, MARKER) }
        : { show: false },
    }))],
    hooks: { draw: [(u) => dashed(u, mark), (u) => bars(u, sets)] },
  });
  const align = (sets) => {
    const x = Float64Array.from(new Set(sets.flatMap((s) => Array.from(s.x)))).sort();
    const row = new Map(Array.from(x, (value, i) => [value, i]));
    return [x, ...sets.map((s) => {
      const column = new Array(x.length).fill(null);
      s.x.forEach((value, i) => { column[row.get(value)] = s.y[i]; });
      return column;
    })];
  };
  const shown = figure(title, spec([]), [[0, 1]], height);
  return {
    element: shown.element,
    set: (sets, mark) => {
      const drawn = sets.flatMap(withEnds);
      shown.update(spec(drawn, mark), align(drawn));
    },
  };
}

/** The ends of the bars of a set as sets of their own, which are not drawn: axes and CSV have them; then the set. */
function withEnds(set) {
  if (!set.spread) return [set];
  const end = (sign, name) => ({
    label: `${set.label}, ${name}`, colour: set.colour, hidden: true, x: set.x,
    y: set.y.map((y, i) => (Number.isFinite(set.spread[i]) ? y + sign * set.spread[i] : null)),
  });
  return [end(-1, 'lower end of the bar'), end(1, 'upper end of the bar'), set];
}

/** Bars of the sets that have some, with a cap at each end. */
function bars(u, sets) {
  const CAP = 3 * devicePixelRatio;
  const { ctx: context } = u;
  context.save();
  context.lineWidth = 1.2 * devicePixelRatio;
  sets.forEach((set) => {
    if (!set.spread) return;
    context.strokeStyle = colour(set.colour);
    context.beginPath();
    set.x.forEach((abscissa, i) => {
      if (!(set.spread[i] > 0)) return;
      const [x, low, high] = [u.valToPos(abscissa, 'x', true), u.valToPos(set.y[i] - set.spread[i], 'y', true), u.valToPos(set.y[i] + set.spread[i], 'y', true)];
      context.moveTo(x, low);
      context.lineTo(x, high);
      for (const y of [low, high]) {
        context.moveTo(x - CAP, y);
        context.lineTo(x + CAP, y);
      }
    });
    context.stroke();
  });
  context.restore();
}

function dashed(u, mark) {
  if (mark === undefined) return;
  const { ctx: context, bbox } = u;
  const x = Math.round(u.valToPos(mark, 'x', true));
  context.save();
  context.strokeStyle = colour('muted');
  context.setLineDash([4, 4]);
  context.beginPath();
  context.moveTo(x, bbox.top);
  context.lineTo(x, bbox.top + bbox.height);
  context.stroke();
  context.restore();
}

/** Counts of several samples in common bins. sets: [{label, colour, values}] */
export function histogram(title, xLabel, yLabel, sets, { bins = 30, zero = true, height = 200 } = {}) {
  const all = sets.flatMap((s) => Array.from(s.values)).filter(Number.isFinite);
  let [low, high] = all.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
  if (zero) [low, high] = [Math.min(0, low), Math.max(0, high)];
  if (!(high > low)) high = low + (Math.abs(low) * 0.01 || 1);
  const width = (high - low) / bins;
  const edges = Array.from({ length: bins + 1 }, (_, i) => low + i * width);
  const counts = sets.map((s) => {
    const column = new Array(bins + 1).fill(0);
    for (const v of s.values) {
      if (Number.isFinite(v)) column[Math.min(bins - 1, Math.floor((v - low) / width))] += 1;
    }
    column[bins] = column[bins - 1];
    return column;
  });
  const options = {
    legend: { show: sets.length > 1, live: false },
    cursor: { show: false },
    scales: { x: { time: false, range: () => [low, high] }, y: { range: fromZero } },
    axes: [axis(xLabel, 2), axis(yLabel, 3)],
    series: [{}, ...sets.map((s) => ({
      label: s.label,
      stroke: named(s.colour),
      fill: () => `color-mix(in srgb, ${colour(s.colour)} 28%, transparent)`,
      width: 1.5,
      paths: uPlot.paths.stepped({ align: 1 }),
      points: { show: false },
    }))],
  };
  return figure(title, options, [edges, ...counts], height).element;
}

/** Lines of a plot over time, for readers without colour vision: {css, dash, width} of one after the other. */
const LINES = [{ css: 'solid', width: 1.5 }, { css: 'dashed', dash: [8, 4], width: 1.5 }, { css: 'dotted', dash: [2, 3], width: 1.8 }, { css: 'double', width: 3 }];
const lineOf = (i) => LINES[i % LINES.length];

/** Columns over time, cursor shared with the other plots of the session. */
export function timePlot(title, yLabel, time, sets, height = 190) {
  const options = {
    legend: { show: true, live: true, markers: { width: 2, dash: (_, series) => lineOf(series - 1).css } },
    cursor: { sync: { key: 'session' }, drag: { x: true, y: false }, points: { size: 6 } },
    scales: { x: { time: false }, y: {} },
    axes: [axis('Time (s)', 2), axis(yLabel, 3)],
    series: [
      { label: 'Time (s)', value: (_, v) => (v === null ? '\u2013' : v.toFixed(3)) },
      ...sets.map((s, i) => ({
        label: s.label,
        stroke: named(s.colour),
        width: lineOf(i).width,
        pxAlign: 0,
        dash: lineOf(i).dash,
        points: { show: false },
        value: (_, v) => (v === null || v === undefined ? '\u2013' : String(Number(v.toPrecision(3))).replace('-', '\u2212')),
      })),
    ],
  };
  return figure(title, options, [time, ...sets.map((s) => s.values)], height).element;
}
