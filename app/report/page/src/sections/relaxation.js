// SPDX-License-Identifier: AGPL-3.0-or-later
// How the tissue relaxes: the same press at three speeds, and a press that is held.
import { el, paragraph, table } from '../dom.js';
import { curvePlot } from '../plot.js';
import * as units from '../units.js';

const COLOURS = ['series-1', 'series-3', 'series-5'];
const WAYS = ['fast', 'medium', 'slow'];

/** Press and release apart: both have ascending abscissae. */
function branches(press, way, colour, { length, force }) {
  const x = Array.from(press.depth, (d) => d * length.factor), y = Array.from(press.force, (f) => f * force.factor);
  const deepest = x.indexOf(Math.max(...x));
  const label = `${way}, ${units.duration(press.time)}`;
  return [
    { label, colour, x: x.slice(0, deepest + 1), y: y.slice(0, deepest + 1) },
    { label: `${label}, released`, colour, dash: [5, 4], x: x.slice(deepest).reverse(), y: y.slice(deepest).reverse() },
  ];
}

function legend(relaxation) {
  const swatch = (colour) => {
    const mark = el('span', { class: 'swatch' });
    mark.style.background = `var(--${colour})`;
    return mark;
  };
  const peak = (press) => Math.max(...press.force);
  return table(['Press', 'Takes', 'Largest force', 'Over the fast one'], relaxation.presses.map((press, i) => [
    [swatch(COLOURS[i]), WAYS[i]], units.duration(press.time), units.force(peak(press)),
    units.percent(peak(press) / peak(relaxation.presses[0]))]));
}

export function relaxationSection({ relaxation }) {
  const axes = { length: units.axis.length(relaxation.depth), force: units.axis.force(Math.max(...relaxation.presses[0].force)) };
  const loops = curvePlot('The same press at three speeds', `Depth (${axes.length.name})`, `Force (${axes.force.name})`, 240);
  const held = curvePlot('A press that is held', 'Time (s)', `Force (${axes.force.name})`, 200);
  loops.set(relaxation.presses.flatMap((press, i) => branches(press, WAYS[i], COLOURS[i], axes)));
  held.set([{ label: 'force', colour: 'series-1', x: Array.from(relaxation.hold.time), y: Array.from(relaxation.hold.force, (f) => f * axes.force.factor) }]);
  const force = relaxation.hold.force;
  return el('section', { id: 'relaxation' }, el('h2', {}, 'How the tissue relaxes'),
    paragraph(`Node ${relaxation.vertex}, pressed ${units.length(relaxation.depth)} deep by the runtime. Held, the force falls to ${units.percent(force[force.length - 1] / force[0])} of its first value in ${units.duration(relaxation.hold.time[relaxation.hold.time.length - 1])}.`, 'lead'),
    loops.element, legend(relaxation),
    paragraph('Solid: pressed. Dashed: released; the area between both is the energy that is lost, and where the force is zero the skin lags behind the tool.', 'note'),
    held.element,
    table(['Relaxation time', 'Part of the force: median', 'from', 'to'], relaxation.fractions.map((f) => [
      units.duration(f.time), units.percent(f.median), units.percent(f.least), units.percent(f.most)])));
}
