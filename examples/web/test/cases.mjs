// Runs through singular positions, made the same way by whoever runs them.

export const CASES = [
  { method: "rk4", step: 0.001, until: 8, every: 0.25, torque: 5 },
  { method: "dop853", rtol: 1e-10, until: 8, every: 0.25, torque: 5 },
  { method: "radau5", rtol: 1e-7, until: 8, every: 0.25, torque: 5 },
];

/** The states of a run at equal intervals, as bits. */
export function run(engine, { method, step, rtol, until, every, torque }) {
  engine.method(method, step === undefined ? { rtol } : { step });
  engine.input({ torque }).assemble();
  const states = [];
  for (let place = 1; place <= Math.round(until / every); place++) {
    const { t, q, v } = engine.advance(place * every).state;
    states.push([t, ...q, ...v].map(bits));
  }
  return states;
}

function bits(number) {
  const view = new DataView(new ArrayBuffer(8));
  view.setFloat64(0, number);
  return view.getBigUint64(0).toString(16).padStart(16, "0");
}
