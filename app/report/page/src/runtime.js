// SPDX-License-Identifier: AGPL-3.0-or-later
// The runtime of palpate, compiled to WebAssembly, by its C interface (runtime/palpate.h). Units are SI.

// Bits of a step.
export const CONTACT = 1, SLIDING = 1 << 3, AT_BORDER = 1 << 4, ENERGY_LIMITED = 1 << 5, BEYOND_DEPTH = 1 << 6,
  BAD_INPUT = 1 << 7, FORCE_LIMITED = 1 << 9;

// Where the fields of the structs lie, in bytes; the layout of wasm32 is that of x86-64.
const SETTINGS = { size: 40, friction: 8, tank_cap: 16, lipschitz_bound: 24, search_rate: 32 };
const OBSERVATION = 200;
const SKIN = { size: 40, vertices: 4, triangles: 8 };
const INFO = { size: 112, friction: 32, depth: 40, lipschitz_bound: 104 };
const BAD_DESCRIPTOR = 8;  // of WASI: there are no files

/** A number as the settings take it: undefined leaves the default. */
function put(view, at, value) {
  if (value !== undefined) view.setFloat64(at, value, true);
}

export class Runtime {
  /** bytes: palpate.wasm. A failure inside throws an Error with the message; the object is then of no more use. */
  constructor(bytes) {
    const refused = () => BAD_DESCRIPTOR;
    this.calls = new WebAssembly.Instance(new WebAssembly.Module(bytes), {
      host: { fail: (at) => { throw new Error(this.text(at)); } },
      wasi_snapshot_preview1: { fd_close: refused, fd_seek: refused, fd_write: refused },
    }).exports;
    this.calls._initialize();
    this.scratch = this.room(512);
  }

  view() { return new DataView(this.calls.memory.buffer); }  // anew: memory that grows is another buffer

  text(at) {
    const bytes = new Uint8Array(this.calls.memory.buffer, at);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  room(size) {
    const at = this.calls.malloc(size);
    if (at === 0) throw new Error('out of memory');
    return at;
  }

  check(result) {
    if (result !== 0) throw new Error(this.text(this.calls.palpate_last_error()));
  }

  /** What the call leaves behind at the pointer that it is given. */
  made(call) {
    const at = this.scratch;
    this.check(call(at));
    return this.view().getUint32(at, true);
  }

  version() { return this.text(this.calls.palpate_version()); }

  /** What the call makes of a file in memory. */
  read(bytes, call) {
    const at = this.room(bytes.length);
    new Uint8Array(this.calls.memory.buffer, at, bytes.length).set(bytes);
    const handle = this.made((to) => call(at, bytes.length, to));
    this.calls.free(at);
    return handle;
  }

  /** bytes: a flat library (.plib). @return its handle */
  load(bytes) {
    return this.read(bytes, (at, size, to) => this.calls.palpate_library_load_memory(at, size, to));
  }

  /** bytes: deformation.pdef of the library. */
  loadSkin(library, bytes) {
    return new Skin(this, this.read(bytes, (at, size, to) => this.calls.palpate_deformation_load_memory(library, at, size, to)));
  }

  describe(library) {
    const at = this.scratch;
    this.view().setUint32(at, INFO.size, true);
    this.check(this.calls.palpate_library_describe(library, at));
    const number = (offset) => this.view().getFloat64(at + offset, true);
    return { friction: number(INFO.friction), depth: number(INFO.depth), lipschitzBound: number(INFO.lipschitz_bound) };
  }

  /** One tool on one body. What the settings leave out is as palpate_settings_default has it. */
  state(library, { friction, tankCap, lipschitzBound } = {}) {
    const at = this.room(SETTINGS.size);
    this.calls.palpate_settings_default(at);
    put(this.view(), at + SETTINGS.friction, friction);
    put(this.view(), at + SETTINGS.tank_cap, tankCap);
    put(this.view(), at + SETTINGS.lipschitz_bound, lipschitzBound);
    const state = this.made((to) => this.calls.palpate_state_create(library, at, to));
    this.calls.free(at);
    return new State(this, state);
  }
}

/** The skin as it is pressed. */
class Skin {
  constructor(runtime, handle) {
    const { calls, scratch } = runtime;
    this.runtime = runtime;
    this.handle = handle;
    runtime.view().setUint32(scratch, SKIN.size, true);
    runtime.check(calls.palpate_deformation_describe(handle, scratch));
    this.vertices = runtime.view().getInt32(scratch + SKIN.vertices, true);
    this.triangles = runtime.view().getInt32(scratch + SKIN.triangles, true);
    this.at = runtime.room(24 * this.vertices);
  }

  /** Three vertices a triangle. */
  facets() {
    const { runtime, triangles } = this;
    const at = runtime.room(12 * triangles);
    runtime.check(runtime.calls.palpate_deformation_triangles(this.handle, at, triangles));
    const copy = new Int32Array(runtime.calls.memory.buffer, at, 3 * triangles).slice();
    runtime.calls.free(at);
    return copy;
  }

  /** The vertices after the last step of the state, three coordinates each, m; valid until the next call. */
  deform(state) {
    const { calls } = this.runtime;
    this.runtime.check(calls.palpate_deform(state.handle, this.handle, this.at, this.vertices));
    if (this.positions?.buffer !== calls.memory.buffer) this.positions = new Float64Array(calls.memory.buffer, this.at, 3 * this.vertices);
    return this.positions;
  }
}

class State {
  constructor(runtime, handle) {
    this.runtime = runtime;
    this.handle = handle;
    this.input = runtime.room(72);  // position, velocity, force
    this.seen = runtime.room(OBSERVATION);
  }

  destroy() {
    this.runtime.calls.palpate_state_destroy(this.handle);
    this.runtime.calls.free(this.input);
    this.runtime.calls.free(this.seen);
  }

  reset() { this.runtime.calls.palpate_state_reset(this.handle); }

  /** One step of dt s to the position of the tip. @return { status, force: of the body on the tool, N } */
  step(position, velocity, dt) {
    const { calls } = this.runtime;
    const at = this.input;
    const inputs = new Float64Array(calls.memory.buffer, at, 9);
    inputs.set(position);
    inputs.set(velocity, 3);
    const status = calls.palpate_step(this.handle, at, at + 24, dt, at + 48);
    return { status: status >>> 0, force: Array.from(new Float64Array(calls.memory.buffer, at + 48, 3)) };
  }

  observe() {
    const { runtime, seen } = this;
    runtime.view().setUint32(seen, OBSERVATION, true);
    runtime.check(runtime.calls.palpate_observe(this.handle, seen));
    const view = runtime.view();
    const number = (offset) => view.getFloat64(seen + offset, true);
    const vector = (offset) => [number(offset), number(offset + 8), number(offset + 16)];
    return {
      status: view.getUint32(seen + 4, true),
      element: view.getInt32(seen + 8, true),
      contactPoint: vector(16),
      natural: vector(40),
      normal: vector(64),
      depth: number(88),
      lateral: number(96),
      offset: number(104),
      energy: number(112),
      tank: number(120),
      absorbed: number(128),
      forceOnBody: vector(136),
      lateralOffset: vector(160),
      dissipated: number(184),
      relaxedFraction: number(192),
    };
  }
}
