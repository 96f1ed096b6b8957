// SPDX-License-Identifier: AGPL-3.0-or-later
// Files that the reader takes along.
import { el } from './dom.js';
import { colour } from './theme.js';

/** content: text or Blob */
export function download(name, type, content) {
  const link = el('a', { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** A picture on paper of the colour of the page. */
export function downloadCanvas(name, canvas) {
  const copy = el('canvas', { width: canvas.width, height: canvas.height });
  const context = copy.getContext('2d');
  context.fillStyle = colour('paper');
  context.fillRect(0, 0, copy.width, copy.height);
  context.drawImage(canvas, 0, 0);
  copy.toBlob((blob) => download(name, 'image/png', blob));
}

/** A title as the name of a file. */
export const fileName = (title) => title.toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '');
