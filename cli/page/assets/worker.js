
// What runs a mechanism beside the page, which goes on moving meanwhile.
//
// In:  `{ run, module }` once; then requests: parameters, inputs, start.
// Out: for each request the run, or why there is none.

/** The most numbers that the frames of the moving picture may have together. */
const PLACES = 400_000;
let sliders = null;
let compiled = null;

addEventListener("message", async ({ data }) => {
  try {
    if (data.sliders) {
      sliders = data.sliders;
      compiled = await WebAssembly.compile(data.module);
    }
    postMessage(data.sliders ? begun(data) : ran(data));
  } catch (error) {
    postMessage({ number: data.number, error: error.message });
  }
});

/** A new mechanism: one that failed may be in any state. */
function mechanism({ parameters, inputs }) {
  const made = new Mechanism(new WebAssembly.Instance(compiled, {}));
  const { method, steps, settings } = sliders;
  return made.set(parameters).input(inputs).method(method, steps).settings(settings);
}

/** What is given for the start, and the inputs there. */
function begun(request) {
  const made = mechanism(request);
  const { held, guessed } = request;
  const every = Math.max(sliders.every, 1e-3);
  const { columns } = made.assemble({ held, guessed }).run({ until: 0, every, columns: ["inputs"] });
  const inputs = Object.fromEntries(made.inputs.map(({ name }) => [name, columns[name][0]]));
  return { number: request.number, begun: { start: made.start, inputs } };
}

/** A run, with its picture. */
function ran(request) {
  const made = mechanism(request);
  const { held, guessed } = request;
  const { until, every, columns } = sliders;
  const run = made.assemble({ held, guessed }).run({ until, every, columns });
  return { number: request.number, run: { ...run, scene: request.drawn ? drawn(made, run.columns) : null } };
}

/** The frames of a run, as the page has them. */
function drawn(made, columns) {
  const names = made.coordinates.map(({ name }) => name);
  const states = made.states.map(({ name }) => name);
  const at = (row, all) => all.map((name) => columns[name][row]);
  const frame = (row) => {
    made.state = { t: columns.t[row], q: at(row, names), v: at(row, names.map((name) => `der(${name})`)), states: at(row, states) };
    return made.shapes.flatMap(({ points, radius }) => [...points.flat(), ...(radius === undefined ? [] : [radius])]);
  };
  const first = frame(0);
  const rows = columns.t.length;
  const most = Math.max(2, Math.min(rows, Math.floor(PLACES / Math.max(first.length, 1))));
  const places = Array.from({ length: most }, (_, i) => (rows < 2 ? 0 : Math.floor((i * (rows - 1)) / (most - 1))));
  const kept = rows < 2 ? [0] : places;
  const frames = new Float32Array(kept.length * first.length);
  kept.forEach((row, i) => frames.set(frame(row), i * first.length));
  return { times: Float64Array.from(kept, (row) => columns.t[row]), frames };
}
