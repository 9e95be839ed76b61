/** What a mechanism has of one name. */
export interface Quantity {
  readonly name: string;
  /** As the description writes it; empty if it gives none. */
  readonly unit: string;
  readonly docs: string;
}

/** Time (s), coordinates and velocities, in the order of `coordinates`, and states of the
 * first order, in the order of `states`. */
export interface State {
  t: number;
  q: number[];
  v: number[];
  states: number[];
}

/** A coordinate, a velocity `der(name)` or a state at the start. */
export interface Given {
  readonly name: string;
  readonly value: number;
  /** Whether the value is held; a guess gives way to the constraints. */
  readonly held: boolean;
}

/** The form of the equations, and what keeps the state on the constraints. */
export interface Settings {
  form?: "reduced" | "full" | "multipliers" | "partitioning";
  stabilisation?: "projection" | "none" | { alpha: number; beta: number };
  /** Singular positions as published, by a decision on the rank alone. */
  published?: boolean;
  /** Steps go across jumps of forces. */
  acrossSwitches?: boolean;
  /** Runs keep the energy of the start. */
  keepEnergy?: boolean;
}

/** What rows of a run have besides time, coordinates, velocities and states. */
export type Columns =
  | "outputs"
  | "inputs"
  | "accelerations"
  | "reactions"
  | "multipliers"
  | "energies"
  | "errors"
  | "rank";

/** A run: its columns by name, the times of passages through singular positions, events: all
 * of them, however many. */
export interface Run {
  columns: Record<string, Float64Array>;
  passages: number[];
  events: { name: string; t: number }[];
}

export type Method = "rk4" | "dp5" | "dop853" | "radau5" | "radau9";

/** Steps that follow the accepted error, or steps of one length (s). */
export type Steps = { rtol?: number; atol?: number } | { step: number };

/** A shape of a picture; points in metres. */
export type Shape =
  | { kind: "line" | "polygon" | "trace"; points: [number, number, number][] }
  | { kind: "circle"; points: [number, number, number][]; radius: number };

/** What went wrong, in the words of the runtime. */
export class MechanismError extends Error {}

/** A mechanism compiled by bricard. Each has an instance of the module of its own. What `set`,
 * `input` and `state` refuse changes nothing. */
export class Mechanism {
  /** Loads a module: by default the one of this package. */
  static load(
    source?: URL | string | Response | BufferSource | WebAssembly.Module,
  ): Promise<Mechanism>;
  constructor(instance: WebAssembly.Instance);

  readonly name: string;
  readonly docs: string;
  readonly coordinates: readonly Quantity[];
  readonly parameters: readonly Quantity[];
  readonly inputs: readonly Quantity[];
  readonly outputs: readonly Quantity[];
  /** States of the first order. */
  readonly states: readonly Quantity[];
  /** The names of events. */
  readonly events: readonly string[];
  /** The names of the reactions of named constraints. */
  readonly multipliers: readonly string[];

  /** The value of a parameter (SI). */
  parameter(name: string): number;
  /** Sets parameters by name (SI). */
  set(values: Record<string, number>): this;
  /** Holds inputs at values; `null` returns one to its default law. */
  input(values: Record<string, number | null>): this;
  /** Chooses the method, and how long its steps are; `dop853` to 1e-9 by default. */
  method(name: Method, steps?: Steps): this;
  /** Chooses the form of the equations; what isn't given is as by default. */
  settings(settings?: Settings): this;
  /** What is given for the start. */
  readonly start: readonly Given[];
  /** Puts the mechanism together at t = 0; velocities are called `der(name)`. */
  assemble(start?: {
    held?: Record<string, number>;
    guessed?: Record<string, number>;
  }): this;
  /** Moves on to a time (s). */
  advance(time: number): this;
  /** Moves on to a time (s) in one run, as the command does, with rows at equal distances
   * of time (s). A run that fails keeps nothing but the last good state. */
  run(run: { until: number; every: number; columns?: readonly Columns[] }): Run;

  /** Where the motion is. A state that is set has to be on the constraints. */
  state: State;
  /** The outputs by name. */
  readonly results: Record<string, number>;
  /** Kinetic and potential energy (J), and the power (W) that is supplied. */
  readonly energy: { kinetic: number; potential: number; power: number };
  /** Accelerations, rates of states, the generalized reaction forces of the constraints. */
  readonly forces: { accelerations: number[]; rates: number[]; reactions: number[] };
  /** The picture. */
  readonly shapes: Shape[];
}
