// A mechanism compiled by bricard, in a browser or in Node.
//
// In:  the WebAssembly module beside this file, or any other that bricard has made.
// Out: `Mechanism`.
//
// A module's memory holds one mechanism, so each `Mechanism` has an instance of its own.

/** The version of the module's functions that this file calls. */
const VERSION = 1;

/** The methods, by the numbers that the module knows them by. */
const METHODS = ["rk4", "dp5", "dop853", "radau5", "radau9"];

/** The kinds of shapes, by the numbers that the module knows them by. */
const SHAPES = ["line", "circle", "polygon", "trace"];

/** What went wrong, in the words of the runtime. */
export class MechanismError extends Error {
  name = "MechanismError";
}

export class Mechanism {
  #wasm;
  #index;

  constructor(instance) {
    this.#wasm = instance.exports;
    const version = this.#wasm.version?.();
    if (version !== VERSION) {
      throw new MechanismError(
        `the module has version ${version} of the functions; this package calls version ${VERSION}`,
      );
    }
    this.#check(this.#wasm.describe());
    const described = JSON.parse(this.#text());
    for (const list of ["coordinates", "parameters", "inputs", "outputs"]) {
      described[list] = Object.freeze(described[list].map(Object.freeze));
    }
    Object.assign(this, described);
    this.#index = {};
    for (const list of ["coordinates", "parameters", "inputs"]) {
      this.#index[list] = new Map(this[list].map(({ name }, place) => [name, place]));
    }
    Object.freeze(this);
  }

  /** Loads a module: by default the one beside this file. */
  static async load(source = new URL("mechanism.wasm", import.meta.url)) {
    const module = source instanceof WebAssembly.Module ? source : await compile(source);
    return new Mechanism(await WebAssembly.instantiate(module, {}));
  }

  /** The value of a parameter. */
  parameter(name) {
    return this.#wasm.parameter(this.#place("parameters", name));
  }

  /** Sets parameters by name. */
  set(values) {
    for (const [name, value] of Object.entries(values)) {
      this.#check(this.#wasm.set_parameter(this.#place("parameters", name), number(value, name)));
    }
    return this;
  }

  /** Holds inputs at values; `null` returns one to its default law. */
  input(values) {
    for (const [name, value] of Object.entries(values)) {
      const place = this.#place("inputs", name);
      this.#check(
        value === null
          ? this.#wasm.free_input(place)
          : this.#wasm.set_input(place, number(value, name)),
      );
    }
    return this;
  }

  /** Chooses the method, and how long its steps are. */
  method(name, { rtol = 1e-9, atol = rtol, step } = {}) {
    const place = METHODS.indexOf(name);
    if (place < 0) {
      throw new MechanismError(`there is no method "${name}"; there are ${METHODS.join(", ")}`);
    }
    this.#check(
      step === undefined
        ? this.#wasm.adaptive(place, number(rtol, "rtol"), number(atol, "atol"))
        : this.#wasm.fixed(place, number(step, "step")),
    );
    return this;
  }

  /** Puts the mechanism together at t = 0: with held values and guesses other than those of
   * the description, if some are given. */
  assemble({ held = {}, guessed = {} } = {}) {
    this.#check(this.#wasm.forget());
    for (const [values, isHeld] of [[guessed, 0], [held, 1]]) {
      for (const [name, value] of Object.entries(values)) {
        this.#check(this.#wasm.begin(this.#coordinate(name), number(value, name), isHeld));
      }
    }
    this.#check(this.#wasm.assemble());
    return this;
  }

  /** Moves on to a time (s). */
  advance(time) {
    this.#check(this.#wasm.advance(number(time, "the time")));
    return this;
  }

  /** Time, coordinates and velocities. */
  get state() {
    const [t, ...rest] = this.#numbers(this.#begun(this.#wasm.state()));
    const n = this.coordinates.length;
    return { t, q: rest.slice(0, n), v: rest.slice(n) };
  }

  set state({ t, q, v }) {
    const n = this.coordinates.length;
    if (q?.length !== n || v?.length !== n) {
      throw new MechanismError(`a state has ${n} coordinates and as many velocities`);
    }
    [t, ...q, ...v].forEach((value, place) =>
      this.#check(this.#wasm.place(place, number(value, "the state"))),
    );
  }

  /** The outputs by name. */
  get results() {
    this.#check(this.#wasm.outputs());
    const values = this.#numbers(this.outputs.length);
    return Object.fromEntries(this.outputs.map(({ name }, place) => [name, values[place]]));
  }

  /** Kinetic and potential energy (J), and the power (W) that is supplied. */
  get energy() {
    const [kinetic, potential, power] = this.#numbers(this.#begun(this.#wasm.energy()));
    return { kinetic, potential, power };
  }

  /** Accelerations, and the generalized reaction forces of the constraints. */
  get forces() {
    this.#check(this.#wasm.forces());
    const n = this.coordinates.length;
    const numbers = this.#numbers(2 * n);
    return { accelerations: numbers.slice(0, n), reactions: numbers.slice(n) };
  }

  /** The shapes of the mechanism's picture. */
  get shapes() {
    this.#begun(this.#wasm.state());
    const numbers = this.#numbers(this.#wasm.draw());
    const shapes = [];
    for (let at = 0; at < numbers.length; ) {
      const kind = SHAPES[numbers[at++]];
      const points = [];
      for (let left = numbers[at++]; left > 0; left--, at += 3) {
        points.push(numbers.slice(at, at + 3));
      }
      shapes.push(kind === "circle" ? { kind, points, radius: numbers[at++] } : { kind, points });
    }
    return shapes;
  }

  #place(list, name) {
    const place = this.#index[list].get(name);
    if (place === undefined) {
      const names = this[list].map(({ name }) => name).join(", ") || "none";
      throw new MechanismError(`${this.name} has no "${name}" among its ${list}: ${names}`);
    }
    return place;
  }

  /** The place of a coordinate, or of the velocity `der(name)`, which come after them. */
  #coordinate(name) {
    const [, of] = /^der\((.*)\)$/.exec(name) ?? [];
    return of === undefined
      ? this.#place("coordinates", name)
      : this.coordinates.length + this.#place("coordinates", of);
  }

  #begun(count) {
    if (count === 0) throw new MechanismError("the mechanism isn't assembled yet");
    return count;
  }

  #check(status) {
    if (status !== 0) throw new MechanismError(this.#text());
  }

  #numbers(count) {
    const { memory, numbers, room } = this.#wasm;
    if (count > room()) {
      throw new MechanismError(`${count} numbers are more than the module has room for: ${room()}`);
    }
    return Array.from(new Float64Array(memory.buffer, numbers(), count));
  }

  #text() {
    const { memory, text, length } = this.#wasm;
    return new TextDecoder().decode(new Uint8Array(memory.buffer, text(), length()));
  }
}

/** Compiles a module from an address, an answer of `fetch`, or bytes. */
async function compile(source) {
  if (source instanceof URL && source.protocol === "file:") {
    const { readFile } = await import("node:fs/promises");
    return WebAssembly.compile(await readFile(source));
  }
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) {
    return WebAssembly.compile(source);
  }
  const answer = source instanceof Response ? source : await fetch(source);
  if (!answer.ok) throw new MechanismError(`${answer.url}: ${answer.status} ${answer.statusText}`);
  return WebAssembly.compile(await answer.arrayBuffer());
}

/** Refuses what JavaScript would silently make a number of. */
function number(value, name) {
  if (typeof value !== "number") {
    throw new MechanismError(`${name} must be a number, not ${JSON.stringify(value)}`);
  }
  return value;
}
