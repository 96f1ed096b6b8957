// SPDX-License-Identifier: AGPL-3.0-or-later
// The body to press with the pointer: the forces are those of the runtime, which runs in the page.
import { el, paragraph } from '../dom.js';
import { download, downloadCanvas } from '../download.js';
import { Hand, MOST_STEPS } from '../hand.js';
import { Model } from '../model.js';
import { Outline } from '../outline.js';
import { responseForce } from '../response.js';
import * as status from '../runtime.js';
import { isDrawn, toolOf } from '../tool-mesh.js';
import { objOf, touchable } from '../touchable.js';
import { TouchView } from '../touch-view.js';
import { dot, minus, times } from '../vectors.js';
import * as units from '../units.js';
import { TimeStrip } from './time-strip.js';
import { FrictionCone } from './friction-cone.js';
import { secantField } from './secant-field.js';

const STEPS = 20;  // of the depth by wheel and keys
const STEADY = 1e-6;  // of the force, in a frame
const TICK = 1 / 60;  // s, of the first frame

const HELP = 'Press on the body: the tool goes in along the inward normal to the depth of the slider; the wheel changes the depth while you press. '
  + 'Drag to slide, release to lift. Drag beside the body to turn it. With the keyboard: space presses, arrows slide, page up and down change the depth.';
const CAPTION = 'The forces are computed in this page by the runtime of palpate, 1000 steps a second. ';
const DEFORMED = 'The skin is that of the solved states, blended by the runtime. ';
const IMPRINT = 'The dent is the imprint of the tool on the undeformed skin, not the deformation of the body: ';
const WHY_IMPRINT = {
  none: () => 'no displacements are kept. A campaign keeps them for a case with depths = 4 in [deformation]; measurements have none. ',
  play: () => 'no displacements lie beside the library. ',
  other_library: () => 'deformation.pdef is of another library. Run palpate build again. ',
  other_skin: () => 'deformation.pdef is of another skin than that of the body. Run palpate build again. ',
  too_large: (skin) => `deformation.pdef has ${units.bytes(skin.bytes)}, and a page takes at most ${units.bytes(skin.limit)}. Fewer modes in [deformation] make it smaller. `,
};

/** Normal force and lateral force on the body, N. */
function forces(seen) {
  const normal = dot(seen.forceOnBody, seen.normal);
  return { normal, lateral: Math.hypot(...minus(seen.forceOnBody, times(normal, seen.normal))) };
}

/** Where the skin in the picture comes from. */
function skinText({ touch, play }) {
  const { skin } = touch;
  if (skin?.file) return DEFORMED;
  return IMPRINT + WHY_IMPRINT[skin?.problem ?? (play ? 'play' : 'none')](skin);
}

const WORDS = [[status.BEYOND_DEPTH, 'beyond the deepest sample: extrapolated'], [status.AT_BORDER, 'at a border'],
  [status.ENERGY_LIMITED, 'limited by the energy rule'], [status.FORCE_LIMITED, 'slide rate-limited'],
  [status.SLIDING, 'sliding']];

function stateText(seen) {
  if (!seen || seen.element < 0) return 'no contact';
  return WORDS.find(([bit]) => seen.status & bit)?.[1] ?? 'in contact, sticking';
}

/** The figures of the last step. */
class Readings {
  constructor(friction, relaxes) {
    this.cone = new FrictionCone(friction);
    this.strip = relaxes ? new TimeStrip('Normal force', [{ name: 'if elastic', colour: 'muted', dash: true }, { name: 'normal force', colour: 'series-3' }], units.force) : null;
    this.friction = friction;
    const names = [['state', 'State'], ['depth', 'Depth'], ['normal', 'Normal force'], ['lateral', 'Lateral force'],
      ['used', `Friction, \u03bc = ${units.significant(friction)}`], ['energy', 'Stored energy'], ['tank', 'Energy tank'],
      ['absorbed', 'Absorbed'], ...(relaxes ? [['relaxed', 'Relaxed'], ['dissipated', 'Dissipated'], ['elastic', 'Normal force, if elastic']] : []), ['margin', 'Absorbed \u2212 (stored + tank)']];
    this.outputs = Object.fromEntries(names.map(([key]) => [key, el('output', { id: `touch-${key}` })]));
    this.element = el('div', {},
      el('dl', { class: 'facts' }, names.flatMap(([key, name]) => [el('dt', {}, name), el('dd', {}, this.outputs[key])])),
      this.cone.element, this.strip?.element);
    this.show({ seen: null, least: Infinity, time: 0 });
  }

  show(hand) {
    const { seen, least } = hand;
    const touching = seen !== null && seen.element >= 0;
    const { normal, lateral } = touching ? forces(seen) : { normal: 0, lateral: 0 };
    const put = (key, text) => { this.outputs[key].textContent = text; };
    put('state', stateText(seen));
    put('depth', units.scaledLength(touching ? seen.depth : 0));
    put('normal', units.force(normal));
    put('lateral', units.force(lateral));
    put('used', normal > 0 && this.friction > 0 ? `${units.percent(lateral / (this.friction * normal))} of the cone` : '\u2013');
    put('energy', units.energy(seen?.energy ?? 0));
    put('tank', units.energy(seen?.tank ?? 0));
    put('absorbed', units.energy(seen?.absorbed ?? 0));
    this.showMargin(seen, least);
    this.cone.show(normal, lateral);
    if (this.strip) this.showRelaxation(hand, touching, normal);
  }

  showRelaxation({ seen, elasticSeen, time }, touching, normal) {
    const elastic = elasticSeen && elasticSeen.element >= 0 ? forces(elasticSeen).normal : 0;
    this.outputs.relaxed.textContent = `${units.percent(touching ? seen.relaxedFraction : 0)} of the normal force`;
    this.outputs.dissipated.textContent = units.energy(seen?.dissipated ?? 0);
    this.outputs.elastic.textContent = units.force(elastic);
    this.strip.add(time, [elastic, normal]);
    this.strip.draw();
  }

  showMargin(seen, least) {
    const passive = !(least < -1e-12);
    const now = seen ? seen.absorbed - seen.energy - seen.tank : 0;
    this.outputs.margin.textContent = `${units.energy(Math.abs(now) < 1e-15 ? 0 : now)}; ${passive ? 'passive' : `violated: ${units.energy(least)}`}`;
    this.outputs.margin.className = passive ? '' : 'warn';
  }
}

/** The body, the hand and the readings, joined by the frames of the browser. */
class Touch {
  constructor(data) {
    const { runtime, library, skin, skinOfPoint } = touchable(data);
    this.skin = skin;
    this.skinOfPoint = skinOfPoint;
    this.friction = data.certificate ? runtime.describe(library).friction : 0;
    this.relaxes = Boolean(data.relaxation);
    this.relaxed = 0;
    const state = () => runtime.state(library, { friction: this.friction });
    this.hand = new Hand(state(), data.key.depth || runtime.describe(library).depth, this.relaxes ? state() : null);
    this.readings = new Readings(this.friction, this.relaxes);
    this.data = data;
    this.makeView();
    this.frame = (now) => this.tick(now);
    this.running = false;
  }

  makeView() {
    const { data } = this;
    const start = Math.max(0, data.chosen.stiffest);
    this.view = new TouchView(new Model(data), {
      facing: data.chosen.stiffest < 0 ? [1, -1, 0.4] : Array.from(data.vertices.inward.subarray(3 * start, 3 * start + 3), (x) => -x),
      tool: toolOf(data),
      skinOfPoint: this.skinOfPoint,
      hand: { press: (spot) => this.press(spot), drag: (spot) => this.drag(spot), lift: () => this.lift(),
        toggle: () => this.toggle(), deepen: (steps) => this.deepen(steps) },
    });
    this.view.inclusions = data.inclusions.map((inclusion) => new Outline(inclusion));
    this.view.cursor = this.view.spotOfNode(start);
    this.view.setField(secantField(data));
    const largest = responseForce(data.normal, start, this.hand.deepest);
    this.unit = largest > 0 ? largest : 1;
  }

  /** The tool goes on from this node; one that is pressed is lifted first. */
  goTo(vertex) {
    if (this.hand.pressed) this.toggle();
    this.view.cursor = this.view.spotOfNode(vertex);
  }

  press(spot) { this.hand.press(spot); this.run(); }

  drag(spot) { this.hand.drag(spot); this.run(); }

  lift() { this.hand.lift(); this.run(); }

  toggle() {
    if (this.hand.pressed) this.lift();
    else this.press(this.view.cursor);
    this.onToggle?.(this.hand.pressed);
  }

  deepen(steps) { this.setDepth(this.hand.depth + (steps * this.hand.deepest) / STEPS); }

  setDepth(depth) {
    this.hand.depth = Math.max(0, Math.min(this.hand.deepest, depth));
    this.onDepth?.(this.hand.depth);
    if (this.hand.spot) this.run();
  }

  clear() {
    this.hand.clear();
    this.shown = null;
    this.onToggle?.(false);
    this.show();
  }

  run() {
    if (this.running) return;
    this.setRunning(true);
    this.last = null;
    requestAnimationFrame(this.frame);
  }

  setRunning(running) {
    if (running === this.running) return;
    this.running = running;
    this.onMove?.(running);
  }

  /** Frames go on until the tool rests. */
  tick(now) {
    this.hand.advance(this.last === null ? TICK : (now - this.last) / 1000);
    this.last = now;
    this.show();
    this.setRunning(!this.hand.resting() || this.stillRelaxes());
    if (this.running) requestAnimationFrame(this.frame);
    else this.view.draw();
  }

  /** Whether the force of a tool at rest has changed since the last frame. */
  stillRelaxes() {
    const before = this.relaxed;
    this.relaxed = this.hand.touching() ? this.hand.seen.relaxedFraction : 0;
    return Math.abs(this.relaxed - before) > STEADY;
  }

  show() {
    const { hand } = this;
    this.readings.show(hand);
    const touching = hand.touching();
    if (!touching) this.shown = null;
    const still = touching && this.isStill();
    this.view.place(hand.spot && { tip: hand.tip(), axis: touching ? hand.seen.normal : hand.spot.inward, force: hand.force ?? [0, 0, 0], unit: this.unit,
      still, skin: this.skin && touching && !still ? this.skin.deform(hand.state) : null });
  }

  /** Whether the contact is that of the last frame: a held tool on tissue that relaxes moves no skin. */
  isStill() {
    const { seen } = this.hand;
    const now = [...this.hand.tip(), ...seen.contactPoint, seen.depth, seen.lateral];
    const still = this.shown?.every((x, i) => x === now[i]) ?? false;
    this.shown = now;
    return still;
  }
}

function controls(touch) {
  const { hand, data } = touch;
  const depthText = el('output', { id: 'touch-set' }, units.scaledLength(hand.depth));
  const slider = el('input', { type: 'range', min: 0, max: 1, step: 0.01, value: hand.depth / hand.deepest, 'aria-label': 'Depth of the press',
    oninput: (e) => touch.setDepth(e.target.value * hand.deepest) });
  touch.onDepth = (depth) => {
    slider.value = depth / hand.deepest;
    depthText.textContent = units.scaledLength(depth);
  };
  const elastic = touch.relaxes && el('label', { title: 'The tissue does not relax: the force is that of the first instant' },
    el('input', { type: 'checkbox', id: 'touch-switch', onchange: (e) => { hand.elastic = e.target.checked; touch.clear(); } }), 'elastic');
  const node = el('input', { type: 'number', id: 'touch-node', min: 0, max: data.vertices.response_status.length - 1, 'aria-label': 'Node to press',
    onchange: (e) => { if (e.target.value !== '') touch.goTo(Number(e.target.value)); } });
  touch.onNode = (vertex) => {
    node.value = vertex;
    touch.goTo(vertex);
  };
  const press = el('button', { type: 'button', id: 'touch-press', onclick: () => touch.toggle() }, 'Press');
  touch.onToggle = (pressed) => { press.textContent = pressed ? 'Lift' : 'Press'; };
  return el('div', { class: 'controls' },
    el('label', {}, 'Depth', slider, depthText),
    el('label', {}, 'Node', node), press, elastic,
    el('button', { type: 'button', onclick: () => touch.clear() }, 'Reset'),
    el('button', { type: 'button', id: 'touch-csv', title: `Each step since the reset, at most ${MOST_STEPS / 1000} s`,
      onclick: () => download('touch.csv', 'text/csv', hand.csv()) }, 'Steps as CSV'),
    touch.skin && el('button', { type: 'button', id: 'touch-obj', title: 'The skin as it is pressed now, in metres',
      onclick: () => download('skin.obj', 'model/obj', objOf(touch.skin, touch.skin.deform(hand.state))) }, 'Skin as OBJ'),
    el('span', {},
      el('button', { type: 'button', 'aria-label': 'Zoom in', onclick: () => touch.view.zoomBy(1.25) }, '+'), ' ',
      el('button', { type: 'button', 'aria-label': 'Zoom out', onclick: () => touch.view.zoomBy(0.8) }, '\u2212'), ' ',
      el('button', { type: 'button', onclick: () => downloadCanvas('touch.png', touch.view.canvas) }, 'PNG')));
}

function friction(data) {
  return data.certificate ? '' : 'The library has no certificate and so no coefficient of friction: the tool slips without friction.';
}

/** The node that the reader chose last is the next to be pressed. */
function follow(nodes, touch) {
  nodes?.onChange(() => {
    const { picked } = nodes;
    if (picked.length) touch.onNode(picked[picked.length - 1].vertex);
  });
}

export function touchSection(data, nodes = null) {
  const section = (...content) => el('section', { id: 'touch' }, el('h2', {}, 'Touch it'), ...content);
  if (!data.touch) {
    return section(paragraph('This palpate was built without the WebAssembly toolchain, so the body cannot be touched here: run scripts/setup, build again and write the report anew.', 'note'));
  }
  const touch = new Touch(data);
  const shape = isDrawn(toolOf(data)) ? '' : 'The tool is drawn as a sphere of its radius. ';
  const element = section(
    paragraph(HELP, 'lead'),
    controls(touch),
    el('div', { class: 'split' },
      el('div', {}, touch.view.element, el('p', { class: 'note', id: 'touch-caption' }, CAPTION + skinText(data) + shape + friction(data))),
      touch.readings.element));
  follow(nodes, touch);
  touch.onMove = (moving) => { element.dataset.moving = String(moving); };
  return element;
}
