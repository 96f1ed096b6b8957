// SPDX-License-Identifier: AGPL-3.0-or-later
// Canvases take their colours from the style sheet and are drawn again when those change: with the
// colour scheme of the reader, and for paper, which is always light.
const listeners = new Set();
const known = new Map();  // asking the style sheet in every frame would lay out the page in every frame
const notify = () => {
  known.clear();
  listeners.forEach((f) => f());
};

export function colour(name) {
  if (!known.has(name)) known.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return known.get(name);
}

export const onThemeChange = (f) => listeners.add(f);

export function watchTheme() {
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', notify);
  const print = (on) => () => {
    document.documentElement.toggleAttribute('data-print', on);
    notify();
  };
  addEventListener('beforeprint', print(true));
  addEventListener('afterprint', print(false));
}

export function rgb(name) {
  const hex = colour(name).replace('#', '');
  return [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16));
}
