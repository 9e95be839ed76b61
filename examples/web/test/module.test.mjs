// The package as a user installs it: equal to native code to the last bit, through singular
// positions, and clear about mistakes.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { test } from "node:test";
import { Mechanism, MechanismError } from "bricard-engine";
import { CASES, run } from "./cases.mjs";
import { native } from "./native.mjs";

const natively = native(1);

test("every state equals that of native code to the last bit", async () => {
  for (const [place, each] of CASES.entries()) {
    const engine = await Mechanism.load();
    const states = run(engine, each);
    for (const [i, state] of states.entries()) {
      assert.deepEqual(state, natively[place].states[i], JSON.stringify(each));
    }
    assert.ok(engine.state.q[0] > 20, "the crank turns through singular positions");
  }
});

test("the mechanism says what it has", async () => {
  const engine = await Mechanism.load();
  assert.equal(engine.name, "Engine");
  assert.deepEqual(engine.coordinates.map(({ name }) => name), ["crank", "rod", "slider"]);
  assert.deepEqual(engine.parameters[0], {
    name: "L",
    unit: "m",
    docs: "length of crank and connecting rod",
  });
  assert.equal(engine.parameter("ms"), 0.5);
  assert.equal(engine.set({ ms: 0.7 }).parameter("ms"), 0.7);
});

test("energy, reactions and pictures are those of a mechanism", async () => {
  const engine = await Mechanism.load();
  engine.assemble({ held: { "der(crank)": 8 } });
  const sum = ({ kinetic, potential }) => kinetic + potential;
  const before = sum(engine.energy);
  engine.advance(3);
  assert.ok(Math.abs(sum(engine.energy) - before) < 1e-6 * before);
  const { accelerations, reactions } = engine.forces;
  // A reaction does no work, and the slider has no force but this one.
  const power = reactions.reduce((sum, r, i) => sum + r * engine.state.v[i], 0);
  assert.ok(Math.abs(power) < 1e-9);
  assert.ok(Math.abs(reactions[2] + 0.5 * accelerations[2]) < 1e-9);
  const [line] = engine.shapes;
  assert.equal(line.kind, "line");
  assert.ok(Math.abs(Math.hypot(...line.points[1]) - 0.5) < 1e-12);
  assert.ok(Math.abs(line.points[2][0] - engine.state.q[2]) < 1e-12);
});

test("a run in one call has rows, passages and events, and pieces of it fit together", async () => {
  const engine = await Mechanism.load();
  engine.assemble({ held: { "der(crank)": 8 } });
  const run = engine.run({ until: 3, every: 0.1, columns: ["energies", "errors", "rank"] });
  assert.deepEqual(Object.keys(run.columns).slice(0, 4), ["t", "crank", "rod", "slider"]);
  assert.equal(run.columns.t.length, 31);
  assert.equal(run.columns.t[7], 0.7);
  assert.equal(run.columns.slider[30], engine.state.q[2]);
  assert.ok(run.passages.length > 3 && run.passages.every((t) => t > 0 && t < 3));
  run.columns.constraint_error.forEach((error) => assert.ok(error < 1e-9));
  // So many rows that they come in pieces.
  engine.assemble({ held: { "der(crank)": 8 } });
  const fine = engine.run({ until: 3, every: 1e-4 });
  assert.equal(fine.columns.t.length, 30001);
  for (let row = 0; row <= 30; row++) {
    assert.ok(Math.abs(fine.columns.crank[1000 * row] - run.columns.crank[row]) < 1e-6);
  }
  assert.equal(fine.passages.length, run.passages.length);
});

test("two mechanisms share nothing, and a state can be set", async () => {
  const [one, two] = [await Mechanism.load(), await Mechanism.load()];
  one.set({ ms: 2 }).assemble().advance(1);
  two.assemble().advance(1);
  assert.notDeepEqual(one.state, two.state);
  const kept = two.state;
  const there = two.advance(1.5).state;
  two.state = kept;
  // The steps are not the same ones.
  two.advance(1.5).state.q.forEach((q, i) => assert.ok(Math.abs(q - there.q[i]) < 1e-6));
});

test("mistakes are errors that say what is wrong", async () => {
  const engine = await Mechanism.load();
  const fails = (act, message) => assert.throws(act, (error) => {
    assert.ok(error instanceof MechanismError, String(error));
    assert.match(error.message, message);
    return true;
  });
  fails(() => engine.set({ mass: 1 }), /Engine has no "mass" among its parameters: L, m, ms, J/);
  fails(() => engine.set({ ms: "1" }), /ms must be a number, not "1"/);
  fails(() => engine.set({ ms: NaN }), /ms must be a finite number, not NaN/);
  fails(() => engine.advance(1), /isn't assembled yet/);
  fails(() => engine.state, /isn't assembled yet/);
  fails(() => engine.method("euler"), /there is no method "euler"; there are rk4/);
  fails(() => engine.settings({ form: "other" }), /there is no form "other"; there are reduced/);
  fails(() => engine.settings({ stabilisation: { alpha: -1, beta: 1 } }), /gains .* must be positive/);
  fails(() => engine.run({ until: 1, every: 0.1 }), /isn't assembled yet/);
  fails(() => engine.run({ until: 1, every: 0.1, columns: ["speed"] }), /no columns "speed"/);
  fails(() => engine.run({ until: 1 }), /every must be a number/);
  fails(() => engine.method("rk4", { rtol: 1e-6 }), /has no error estimate/);
  fails(() => engine.assemble({ held: { crank: 0, rod: 2 } }), /./);
  engine.assemble();
  fails(() => engine.advance(-1), /the end must be a number and not come earlier/);
  fails(() => (engine.state = { t: 0, q: [1], v: [1] }), /3 coordinates/);
  assert.equal(engine.advance(0.1).state.t, 0.1);
  await assert.rejects(Mechanism.load(new ArrayBuffer(3)), WebAssembly.CompileError);
});

test("what is refused changes nothing", async () => {
  const engine = await Mechanism.load();
  engine.input({ torque: 5 }).assemble({ held: { "der(crank)": 3 } });
  const parameters = () => engine.parameters.map(({ name }) => engine.parameter(name));
  const known = () => [engine.state, engine.start, parameters(), engine.energy.power];
  const before = known();
  const { t, q, v, states } = engine.state;
  for (const act of [
    () => engine.set({ ms: 3, nope: 1 }),
    () => engine.set({ ms: 3, m: "1" }),
    () => engine.set({ ms: 3, m: Infinity }),
    () => engine.input({ torque: 7, nope: 1 }),
    () => engine.input({ torque: null, nope: null }),
    () => engine.assemble({ held: { "der(crank)": 1 }, guessed: { nope: 1 } }),
    () => engine.assemble({ held: { "der(crank)": 1, rod: NaN } }),
    () => (engine.state = { t: 1, q: [q[0], 0.1, NaN], v, states }),
    () => (engine.state = { t: 1, q, v: [0, 0, "0"], states }),
    () => (engine.state = { t: NaN, q: [1, 1, 1], v, states }),
  ]) {
    assert.throws(act, MechanismError);
    assert.deepEqual(known(), before, String(act));
  }
  assert.equal(t, 0);
});

test("the module is small", () => {
  const bytes = statSync(new URL(import.meta.resolve("bricard-engine/mechanism.wasm"))).size;
  console.log(`${bytes} bytes`);
  assert.ok(bytes < 640_000);
});
