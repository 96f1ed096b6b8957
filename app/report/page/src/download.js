// SPDX-License-Identifier: AGPL-3.0-or-later
// Files that the reader takes along.
import { el } from './dom.js';

/** content: text or Blob */
export function download(name, type, content) {
  const link = el('a', { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
