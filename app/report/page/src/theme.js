// SPDX-License-Identifier: AGPL-3.0-or-later
// Canvases take their colours from the style sheet and are drawn again when those change: with the
// colour scheme of the reader, and for paper, which is always light.
const listeners = new Set();
const notify = () => listeners.forEach((f) => f());

export const colour = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

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
