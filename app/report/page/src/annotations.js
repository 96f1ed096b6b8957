// SPDX-License-Identifier: AGPL-3.0-or-later
// What makes a picture of the body a measure: a scale bar and the axes.
import { colour } from './theme.js';
import { scaledLength } from './units.js';

const FONT = 12;      // pixels
const MARGIN = 14;    // pixels
const AXIS = 26;      // length, pixels
const PART = 0.25;    // longest bar, of the width

/** The longest of 1, 2 and 5 times a power of ten that is not longer, m. */
export function roundLength(longest) {
  const power = 10 ** Math.floor(Math.log10(longest) + 1e-9);
  return [5, 2, 1].map((m) => m * power).find((x) => x <= longest * (1 + 1e-9));
}

/** pixelsPerMetre: of this raster; scale: raster pixels in one of the style sheet. @return the length, m */
export function drawScaleBar(context, { width, height, pixelsPerMetre, scale }) {
  const length = roundLength((PART * width) / pixelsPerMetre);
  const [x, y, end] = [MARGIN * scale, height - MARGIN * scale, MARGIN * scale + length * pixelsPerMetre];
  context.strokeStyle = context.fillStyle = colour('ink');
  context.lineWidth = 1.5 * scale;
  context.lineCap = 'butt';
  context.beginPath();
  for (const at of [x, end]) {
    context.moveTo(at, y - 4 * scale);
    context.lineTo(at, y + 4 * scale);
  }
  context.moveTo(x, y);
  context.lineTo(end, y);
  context.stroke();
  context.font = `${FONT * scale}px system-ui, sans-serif`;
  context.textBaseline = 'alphabetic';
  context.fillText(scaledLength(length), x, y - 8 * scale);
  return length;
}

/** rows: right, up and toward the viewer, as of a Camera. */
export function drawAxes(context, { width, height, rows, scale }) {
  const length = AXIS * scale;
  const [x, y] = [width - length - MARGIN * scale, height - length - MARGIN * scale];
  const axes = ['x', 'y', 'z'].map((name, k) => ({ name, right: rows[0][k], up: rows[1][k], toward: rows[2][k] }));
  context.font = `${FONT * scale}px system-ui, sans-serif`;
  context.textBaseline = 'middle';
  context.textAlign = 'center';
  context.lineWidth = 1.5 * scale;
  context.lineCap = 'round';
  for (const { name, right, up, toward } of axes.sort((a, b) => a.toward - b.toward)) {
    context.strokeStyle = context.fillStyle = colour('ink');
    context.globalAlpha = toward < -0.1 ? 0.45 : 1;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + length * right, y - length * up);
    context.stroke();
    if (Math.hypot(right, up) > 0.2) context.fillText(name, x + 1.35 * length * right, y - 1.35 * length * up);
  }
  context.globalAlpha = 1;
  context.textAlign = 'start';
}
