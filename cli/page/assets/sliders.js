// The sliders: what they change is run anew beside the page (worker.js), while the motion
// that is there goes on until there is another one.

/** Positions of a slider on each side of the value that it begins with. */
const STEPS = 100;
/** After this time (ms) a run that nobody waits for any more is broken off. */
const PATIENCE = 1000;

/** How far a slider goes: from zero to twice its value, a turn about an angle. */
function reach(value, unit) {
  const size = unit === "rad" ? Math.PI : Math.abs(value) || 1;
  return [value - size, value + size];
}

class Sliders {
  constructor(place, data, drawn, show) {
    this.place = place;
    this.data = data;
    this.drawn = drawn;
    this.show = show;
    this.module = Uint8Array.from(atob(data.module), (letter) => letter.charCodeAt(0));
    this.script = URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" }));
    /** What is given, by kind and name; of the first run. */
    this.first = {
      parameters: Object.fromEntries(data.parameters.map(({ name, value }) => [name, value])),
      inputs: Object.fromEntries(data.inputs.map(({ name, value }) => [name, value])),
      held: data.held,
      guessed: data.guessed,
    };
    this.number = 0;
    this.waiting = null;
    this.alarm = element("pre", { class: "refused", role: "alert", hidden: "" });
    place.append(this.alarm);
    this.reset();
    this.employ();
  }

  /** Forgets what was changed. */
  reset() {
    this.given = structuredClone(this.first);
  }

  /** Starts a worker, which says what there is. */
  employ() {
    this.worker?.terminate();
    this.worker = new Worker(this.script);
    this.worker.addEventListener("message", ({ data }) => this.hear(data));
    this.worker.addEventListener("error", (event) => this.complain(`the sliders don't work here: ${event.message ?? "no worker can be started"}`));
    this.waiting = { at: performance.now() };
    const { module, parameters, inputs, ...sliders } = this.data;
    this.worker.postMessage({ number: 0, sliders, module: this.module, ...this.first });
  }

  hear({ number, begun, run, error }) {
    this.waiting = null;
    if (begun && !this.rows) this.build(begun);
    else if (error !== undefined && (number === this.number || !this.rows)) this.complain(error);
    else if (run && number === this.number) {
      this.complain(null);
      this.show(run);
    }
    if (this.wanted) this.ask();
    else this.place.setAttribute("aria-busy", "false");
  }

  /** Wants the motion of what is given now. */
  ask() {
    this.wanted = true;
    this.place.setAttribute("aria-busy", "true");
    if (this.waiting) {
      if (performance.now() - this.waiting.at > PATIENCE) this.employ();
      return;
    }
    this.wanted = false;
    this.number += 1;
    this.waiting = { at: performance.now() };
    this.worker.postMessage({ number: this.number, drawn: this.drawn, ...this.given });
  }

  /** Says why the motion is not that of the sliders; clears the message if it is. */
  complain(message) {
    this.place.hidden = false;
    this.alarm.hidden = message === null;
    this.alarm.textContent = message === null ? "" : `${message}\nThe motion is that of before.`;
  }

  /** All sliders, once it is known what there is. */
  build({ start, inputs }) {
    const button = element("button", { type: "button", id: "reset" }, "reset all");
    button.addEventListener("click", () => {
      this.reset();
      for (const row of this.rows) row.put();
      this.ask();
    });
    this.place.hidden = false;
    this.place.prepend(element("div", { class: "tools" }, element("h2", {}, "Change it"), button));
    this.rows = [];
    const add = (box, kind, quantity, value) => box.append(this.row(kind, quantity, value));
    const box = this.group("Parameters", this.data.parameters.length > 0);
    for (const quantity of this.data.parameters) add(box, "parameters", quantity, quantity.value);
    const signals = this.group("Inputs", this.data.inputs.length > 0);
    for (const quantity of this.data.inputs) add(signals, "inputs", quantity, inputs[quantity.name]);
    for (const held of [true, false]) {
      const all = start.filter((given) => given.held === held);
      const place = this.group(held ? "Start" : "Guesses of the start", all.length > 0, !held);
      for (const { name, value } of all) add(place, held ? "held" : "guessed", { name, ...this.data.units[name] }, value);
    }
    this.complain(null);
    this.place.addEventListener("keydown", (event) => {
      // Arrows belong to the slider, digits and signs to the field.
      if (event.target.tagName === "INPUT") event.stopPropagation();
    });
  }

  /** A group of sliders, which may begin closed. */
  group(name, wanted, closed = false) {
    const box = element("details", {}, element("summary", {}, name));
    box.open = !closed;
    if (wanted) this.place.append(box);
    return box;
  }

  /** A slider with a field for any number, and a button that takes it back. */
  row(kind, { name, unit, docs }, value) {
    const id = `${kind} ${name}`;
    const called = withUnit(name, unit && `[${unit}]`);
    const [low, high] = reach(value, unit);
    const slider = element("input", { type: "range", id, min: low, max: high, step: (high - low) / (2 * STEPS) });
    const field = element("input", { type: "text", inputmode: "decimal", "aria-label": called, spellcheck: "false", autocomplete: "off" });
    const back = element("button", { type: "button", title: `as it was`, "aria-label": `${name} as it was` }, "↺");
    const label = element("label", { for: id }, called);
    const about = element("small", {}, docs ?? "");
    const row = { name, kind, value, put: () => put(this.first[kind][name] ?? null) };
    const put = (given) => {
      // Without a given value that of the description counts.
      const now = given ?? value;
      if (now < Number(slider.min) || now > Number(slider.max)) [slider.min, slider.max] = reach(now, unit);
      slider.value = now;
      field.value = String(now);
      field.removeAttribute("aria-invalid");
      about.textContent = [docs, kind === "inputs" && given === null ? "(follows its law)" : null].filter(Boolean).join(" ");
      slider.setAttribute("aria-valuetext", `${now} ${unit}`);
    };
    const give = (given) => {
      if (given === null || given === undefined) delete this.given[kind][name];
      else this.given[kind][name] = given;
      if (kind === "inputs" && given === null) this.given.inputs[name] = null;
      put(given ?? null);
      this.ask();
    };
    slider.addEventListener("input", () => give(rounded(Number(slider.value), high - low)));
    field.addEventListener("change", () => {
      const text = field.value.trim().replace("−", "-");
      const wanted = Number(text);
      if (text !== "" && Number.isFinite(wanted)) give(wanted);
      else {
        field.setAttribute("aria-invalid", "true");
        this.complain(`${called}: ${text === "" ? "nothing" : `"${text}"`} is no number`);
      }
    });
    back.addEventListener("click", () => give(this.first[kind][name] ?? null));
    put(this.first[kind][name] ?? null);
    this.rows.push(row);
    return element("div", { class: "slider" }, label, slider, field, back, about);
  }
}

/** A value of a slider in as few digits as tell its positions apart. */
function rounded(value, range) {
  const digits = Math.min(15, Math.max(0, 3 - Math.floor(Math.log10(range))));
  return Number(value.toFixed(digits));
}
