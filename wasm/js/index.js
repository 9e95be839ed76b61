// A mechanism compiled by bricard, in a browser or in Node.
//
// In:  the WebAssembly module beside this file, or any other that bricard has made.
// Out: `Mechanism`.
//
// A module's memory holds one mechanism, so each `Mechanism` has an instance of its own.

/** The version of the module's functions that this file calls. */
const VERSION = 3;

/** The methods, by the numbers that the module knows them by. */
const METHODS = ["rk4", "dp5", "dop853", "radau5", "radau9"];

/** The forms of the equations of motion, by the numbers that the module knows them by. */
const FORMS = ["reduced", "full", "multipliers", "partitioning"];

/** The kinds of columns that rows of a run may have besides time, coordinates, velocities
 * and states, in the order of their bits and of their places in a row. */
const COLUMNS = {
  outputs: ({ outputs }) => outputs.map(named),
  inputs: ({ inputs }) => inputs.map(named),
  accelerations: ({ coordinates, states }) => [
    ...coordinates.map(({ name }) => `der(der(${name}))`),
    ...states.map(({ name }) => `der(${name})`),
  ],
  reactions: ({ coordinates }) => coordinates.map(({ name }) => `r(${name})`),
  multipliers: ({ multipliers }) => multipliers,
  energies: () => ["kinetic", "potential"],
  errors: () => ["constraint_error", "velocity_error"],
  rank: () => ["rank"],
};

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
    for (const list of ["coordinates", "states", "parameters", "inputs", "outputs"]) {
      described[list] = Object.freeze(described[list].map(Object.freeze));
    }
    for (const list of ["events", "multipliers"]) Object.freeze(described[list]);
    Object.assign(this, described);
    this.#index = {};
    for (const list of ["coordinates", "states", "parameters", "inputs"]) {
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

  // What is given is looked at as a whole before anything is changed, so that what is refused
  // changes nothing.

  /** Sets parameters by name. */
  set(values) {
    const given = Object.entries(values).map(([name, value]) => [
      this.#place("parameters", name),
      finite(value, name),
    ]);
    for (const [place, value] of given) this.#check(this.#wasm.set_parameter(place, value));
    return this;
  }

  /** Holds inputs at values; `null` returns one to its default law. */
  input(values) {
    const { free_input, set_input } = this.#wasm;
    const given = Object.entries(values).map(([name, value]) => [
      this.#place("inputs", name),
      value === null ? null : finite(value, name),
    ]);
    for (const [place, value] of given) {
      this.#check(value === null ? free_input(place) : set_input(place, value));
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

  /** Chooses the form of the equations, and what keeps the state on the constraints:
   * "projection", "none", or the gains of Baumgarte's stabilisation (1/s). */
  settings({ form = "reduced", stabilisation = "projection", published = false, acrossSwitches = false, keepEnergy = false } = {}) {
    const place = FORMS.indexOf(form);
    if (place < 0) {
      throw new MechanismError(`there is no form "${form}"; there are ${FORMS.join(", ")}`);
    }
    const gains = typeof stabilisation === "object";
    const way = gains ? 2 : ["projection", "none"].indexOf(stabilisation);
    if (way < 0) {
      throw new MechanismError(
        `there is no stabilisation "${stabilisation}"; there are projection, none, and { alpha, beta }`,
      );
    }
    const [alpha, beta] = gains
      ? [number(stabilisation.alpha, "alpha"), number(stabilisation.beta, "beta")]
      : [0, 0];
    const bits = (published ? 1 : 0) | (acrossSwitches ? 2 : 0) | (keepEnergy ? 4 : 0);
    this.#check(this.#wasm.settings(place, way, alpha, beta, bits));
    return this;
  }

  /** Coordinates, velocities and states at the start, as they are given: held, or a guess. */
  get start() {
    return this.#startNames().map((name, place) => {
      this.#check(this.#wasm.start(place));
      const [value, held] = this.#numbers(2);
      return { name, value, held: held === 1 };
    });
  }

  /** Puts the mechanism together at t = 0: with held values and guesses other than those of
   * the description, if some are given. */
  assemble({ held = {}, guessed = {} } = {}) {
    const given = [[guessed, 0], [held, 1]].flatMap(([values, isHeld]) =>
      Object.entries(values).map(([name, value]) => [
        this.#beginning(name),
        finite(value, name),
        isHeld,
      ]),
    );
    this.#check(this.#wasm.forget());
    for (const words of given) this.#check(this.#wasm.begin(...words));
    this.#check(this.#wasm.assemble());
    return this;
  }

  /** Moves on to a time (s). */
  advance(time) {
    this.#check(this.#wasm.advance(number(time, "the time")));
    return this;
  }

  /** Moves on to a time (s) in one run, as the command does: with rows at equal distances
   * of time (s), which have the kinds of columns that are wanted. */
  run({ until, every, columns = [] }) {
    const kinds = Object.keys(COLUMNS);
    const unknown = columns.find((kind) => !kinds.includes(kind));
    if (unknown !== undefined) {
      throw new MechanismError(`there are no columns "${unknown}"; there are ${kinds.join(", ")}`);
    }
    const bits = kinds.reduce((sum, kind, i) => sum | (columns.includes(kind) ? 1 << i : 0), 0);
    const added = kinds.filter((kind) => columns.includes(kind));
    const names = ["t", ...this.#startNames(), ...added.flatMap((kind) => COLUMNS[kind](this))];
    const { run, rows, unfinished, width } = this.#wasm;
    const pieces = [];
    const [passages, events] = [[], []];
    do {
      const again = pieces.length > 0 ? 1 : 0;
      this.#check(run(number(until, "until"), number(every, "every"), bits, again));
      pieces.push(this.#view(rows() * width(bits)).slice());
      this.#addHappened(passages, events);
    } while (unfinished() === 1);
    const count = pieces.reduce((sum, piece) => sum + piece.length, 0) / names.length;
    const found = Object.fromEntries(names.map((name) => [name, new Float64Array(count)]));
    // A coordinate or an output may have the name of a column; the first keeps it.
    const places = [...new Set(names)].map((name) => names.indexOf(name));
    let row = 0;
    for (const piece of pieces) {
      for (let at = 0; at < piece.length; at += names.length, row++) {
        places.forEach((i) => (found[names[i]][row] = piece[at + i]));
      }
    }
    return { columns: found, passages, events };
  }

  /** Adds the passages and events of the last piece of a run. */
  #addHappened(passages, events) {
    const marks = this.#numbers(2 * this.#wasm.marks());
    for (let at = 0; at < marks.length; at += 2) {
      const [kind, t] = [marks[at], marks[at + 1]];
      if (kind === 0) passages.push(t);
      else events.push({ name: this.events[kind - 1], t });
    }
  }

  /** Time, coordinates, velocities, and states of the first order. */
  get state() {
    const [t, ...rest] = this.#numbers(this.#begun(this.#wasm.state()));
    const n = this.coordinates.length;
    return { t, q: rest.slice(0, n), v: rest.slice(n, 2 * n), states: rest.slice(2 * n) };
  }

  set state({ t, q, v, states = [] }) {
    const [n, m] = [this.coordinates.length, this.states.length];
    if (q?.length !== n || v?.length !== n || states.length !== m) {
      const more = m > 0 ? ` and ${m} of the first order in \`states\`` : "";
      throw new MechanismError(`a state has ${n} coordinates and as many velocities${more}`);
    }
    const given = [t, ...q, ...v, ...states].map((value) => finite(value, "the state"));
    given.forEach((value, place) => this.#check(this.#wasm.place(place, value)));
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

  /** Accelerations, rates of states of the first order, and the generalized reaction forces
   * of the constraints. */
  get forces() {
    this.#check(this.#wasm.forces());
    const [n, m] = [this.coordinates.length, this.states.length];
    const numbers = this.#numbers(2 * n + m);
    return {
      accelerations: numbers.slice(0, n),
      rates: numbers.slice(n, n + m),
      reactions: numbers.slice(n + m),
    };
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

  /** What a start gives: coordinates, their velocities, states of the first order. */
  #startNames() {
    const names = this.coordinates.map(named);
    return [...names, ...names.map((name) => `der(${name})`), ...this.states.map(named)];
  }

  /** The place of a coordinate, of a velocity `der(name)`, or of a state at the start. */
  #beginning(name) {
    const place = this.#startNames().indexOf(name);
    if (place >= 0) return place;
    const names = [...this.coordinates, ...this.states].map(named).join(", ") || "none";
    throw new MechanismError(
      `${this.name} has no "${name}" among its coordinates and states: ${names}; the velocity of a coordinate is der(name)`,
    );
  }

  #begun(count) {
    if (count === 0) throw new MechanismError("the mechanism isn't assembled yet");
    return count;
  }

  #check(status) {
    if (status !== 0) throw new MechanismError(this.#text());
  }

  #numbers(count) {
    return Array.from(this.#view(count));
  }

  /** Numbers where they are, until the module writes others. */
  #view(count) {
    const { memory, numbers, room } = this.#wasm;
    if (count > room()) {
      throw new MechanismError(`${count} numbers are more than the module has room for: ${room()}`);
    }
    return new Float64Array(memory.buffer, numbers(), count);
  }

  #text() {
    const { memory, text, length } = this.#wasm;
    return new TextDecoder().decode(new Uint8Array(memory.buffer, text(), length()));
  }
}

function named({ name }) {
  return name;
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

/** Refuses what is infinite or NaN, too. */
function finite(value, name) {
  if (!Number.isFinite(number(value, name))) {
    throw new MechanismError(`${name} must be a finite number, not ${value}`);
  }
  return value;
}
