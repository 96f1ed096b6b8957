// SPDX-License-Identifier: AGPL-3.0-or-later
// Elements are made from text nodes only: nothing from an artifact is ever parsed as markup.

/** el('p', {class: 'note', onclick: f}, 'text', child, ...) */
export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else node.setAttribute(key, value === true ? '' : value);
  }
  node.append(...children.flat(Infinity).filter((c) => c !== null && c !== undefined && c !== false));
  return node;
}

export const paragraph = (text, kind) => el('p', { class: kind }, text);

/** rows: arrays of cells; numbers are columns to align right. */
export function table(head, rows, numbers = []) {
  const cell = (tag) => (content, i) =>
    el(tag, { class: numbers.includes(i) ? 'number' : undefined }, content);
  return el('div', { class: 'table' },
    el('table', { class: 'data' },
      el('thead', {}, el('tr', {}, head.map(cell('th')))),
      el('tbody', {}, rows.map((row) => el('tr', {}, row.map(cell('td')))))));
}

export function definitions(pairs, kind) {
  return el('dl', { class: kind },
    pairs.flatMap(([term, value]) => [el('dt', {}, term), el('dd', {}, value)]));
}
