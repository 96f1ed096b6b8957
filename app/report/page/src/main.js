// SPDX-License-Identifier: AGPL-3.0-or-later
import '../vendor/uplot/uPlot.min.css';
import './style.css';
import { readData } from './data.js';
import { el } from './dom.js';
import { Nodes } from './nodes.js';
import { bodySection } from './sections/body.js';
import { calibrationPage, calibrationSection } from './sections/calibration.js';
import { certificateSection } from './sections/certificate.js';
import { comparisonSection } from './sections/comparison.js';
import { Curves } from './sections/curves.js';
import { fidelitySection } from './sections/fidelity.js';
import { fitSection } from './sections/fit.js';
import { headerSection } from './sections/header.js';
import { liveHeader, liveSection } from './sections/live.js';
import { playHeader } from './sections/play.js';
import { overTimePage } from './sections/over-time.js';
import { previewSection } from './sections/preview.js';
import { recordSection } from './sections/record.js';
import { relaxationSection } from './sections/relaxation.js';
import { repairSection } from './sections/repair.js';
import { sessionSection } from './sections/session.js';
import { touchSection } from './sections/touch.js';
import { watchTheme } from './theme.js';

// Attributes of the root element give the state of the page: data-ready "ok" or "failed", data-errors the
// number of failures. A section that cannot be drawn says so in its place.
const root = document.documentElement;
const count = () => { root.dataset.errors = String(Number(root.dataset.errors) + 1); };
addEventListener('error', count);
addEventListener('unhandledrejection', count);

const report = document.getElementById('report');

// report.html?only=body shows one section without its controls, as a figure for a page or a slide.
const only = new URLSearchParams(location.search).get('only');
root.toggleAttribute('data-figure', only !== null);

function place(name, make) {
  if (only !== null && name !== only) return;
  try {
    report.append(make());
  } catch (error) {
    count();
    report.append(el('p', { class: 'failure' }, `The section \u201c${name}\u201d could not be drawn: ${error.message}`));
  }
}

function showReport(data) {
  const nodes = new Nodes(data);
  place('header', () => headerSection(data, nodes));
  place('body', () => bodySection(data, nodes, new Curves(data, nodes)));
  place('touch', () => touchSection(data, nodes));
  if (data.repair) place('repair', () => repairSection(data));
  if (data.relaxation) place('relaxation', () => relaxationSection(data));
  place('fit', () => fitSection(data));
  place('fidelity', () => fidelitySection(data) ?? '');
  if (data.comparison) place('comparison', () => comparisonSection(data));
  if (data.calibration) place('calibration', () => calibrationSection(data));
  place('session', () => sessionSection(data));
  place('certificate', () => certificateSection(data));
  place('record', () => recordSection(data));
}

function showPlay(data) {
  place('header', () => playHeader(data));
  place('touch', () => touchSection(data));
  if (data.relaxation) place('relaxation', () => relaxationSection(data));
  place('certificate', () => certificateSection(data));
}

function showWatch(data) {
  place('header', () => liveHeader(data));
  place('live', () => liveSection(data));
  place('certificate', () => certificateSection(data));
}

function show(data) {
  if (data.preview) {
    place('preview', () => previewSection(data));
  } else if (data.watch) {
    showWatch(data);
  } else if (data.play) {
    showPlay(data);
  } else if (data.over_time) {
    place('over-time', () => overTimePage(data));
  } else if (data.calibration && !data.body) {
    place('calibration', () => calibrationPage(data));
  } else {
    showReport(data);
  }
}

async function open() {
  try {
    watchTheme();
    show(await readData());
  } catch (error) {
    count();
    report.append(el('p', { class: 'failure' }, `The report cannot be shown: ${error.message}`));
  }
  // After the first layout, when the figures have found their width.
  requestAnimationFrame(() => requestAnimationFrame(() => {
    root.dataset.ready = root.dataset.errors === '0' ? 'ok' : 'failed';
  }));
}

open();
