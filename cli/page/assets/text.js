// Text of the page: names, tables, the coloured description. Whatever a description says is
// set as text, never as markup.

/** An element with attributes and children; strings become text. */
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

/** A number in few digits that tell neighbours in a range apart. */
function short(value, range = Math.abs(value)) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0 || Math.abs(value) < 1e-12 * range) return "0";
  const large = Math.max(Math.abs(value), range);
  if (large >= 1e6 || large < 1e-4) return value.toExponential(3).replaceAll("-", "−");
  const digits = Math.min(12, Math.max(0, 4 - Math.floor(Math.log10(large))));
  return value.toFixed(digits).replace("-", "−");
}

/** Numbers at ticks of equal distance, in as many digits as tell them apart. */
function labels(ticks) {
  const step = Math.abs(ticks[1] - ticks[0]) || Math.abs(ticks[0]) || 1;
  const order = (x) => Math.floor(Math.log10(x) + 1e-9);
  // A step of 2.5 takes a digit more than one of 1, 2 or 5.
  const digit = step / 10 ** order(step);
  const whole = Math.abs(digit - Math.round(digit)) < 1e-6;
  const last = order(step) - (whole ? 0 : 1);
  const large = Math.max(...ticks.map(Math.abs));
  const digits = (count) => Math.min(15, Math.max(0, count));
  const label = (y) => {
    if (Math.abs(y) < 1e-6 * step) return "0";
    const powers = large >= 1e6 || large < 1e-4;
    const text = powers ? y.toExponential(digits(order(Math.abs(y)) - last)) : y.toFixed(digits(-last));
    return text.replace(/(\.\d*?)0+(e|$)/, "$1$2").replace(/\.(e|$)/, "$1").replace("e+", "e").replaceAll("-", "−");
  };
  return ticks.map(label);
}

/** Splits a description into words, numbers and comments, for colouring. */
function* tokens(text, words) {
  const kinds = new Map();
  for (const [kind, list] of Object.entries(words)) for (const word of list) kinds.set(word, kind);
  const pattern =
    /(\/\/[^\n]*|\/\*[\s\S]*?\*\/)|(\d[\d_]*(?:\.\d+)?(?:[eE][+-]?\d+)?)|([\p{L}_][\p{L}\p{N}_]*)|(:(?![^;]*\b(?:rising|falling|crossing)\b)\s*[^=;{\n]*)/gu;
  let last = 0;
  for (const found of text.matchAll(pattern)) {
    if (found.index > last) yield [null, text.slice(last, found.index)];
    last = found.index + found[0].length;
    const [whole, comment, number, word, unit] = found;
    if (comment !== undefined) yield ["comment", whole];
    else if (number !== undefined) yield ["number-token", whole];
    else if (unit !== undefined) yield ["unit", whole];
    else yield [kinds.get(word) ?? null, whole];
  }
  yield [null, text.slice(last)];
}

function coloured(text, words) {
  const made = element("pre", { id: "description", tabindex: "0" });
  for (const [kind, part] of tokens(text, words)) {
    made.append(kind === null ? part : element("span", { class: kind }, part));
  }
  return made;
}

function table(rows) {
  const body = element("tbody");
  for (const [name, value, ...more] of rows) {
    const row = element("tr", {}, element("th", { scope: "row" }, name), element("td", { class: "number" }, value));
    for (const text of more) row.append(element("td", {}, text));
    body.append(row);
  }
  return element("table", {}, body);
}

function withUnit(value, unit) {
  return unit ? `${value} ${unit}` : value;
}

/** The command that made the page, with a button that copies it. */
function command(text) {
  const line = element("pre", { id: "command" }, text);
  const button = element("button", { type: "button" }, "copy");
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = "copied";
    } catch {
      // Not every browser lets a file do this: the text is marked, to copy by hand.
      getSelection().selectAllChildren(line);
    }
  });
  return element("div", { class: "command" }, line, button);
}

/** The equations of motion; of their markup, elements of MathML alone are accepted. */
function equations(run) {
  if (run.equations.length === 0) return;
  const place = document.getElementById("equations");
  const constrained = run.equations.some(({ title }) => title.includes("G = "));
  place.append(
    element("h2", {}, "Equations of motion"),
    element("p", { class: "hint" }, constrained ? "M q̈ + C q̇ + h = Q + Gᵀλ, G q̈ = p₂, with these entries:" : "M q̈ + C q̇ + h = Q, with these entries:"),
  );
  for (const { title, zeros, long, lines } of run.equations) {
    const box = element("details", {}, element("summary", {}, title));
    for (const line of lines) {
      const math = new DOMParser().parseFromString(line, "application/xml").documentElement;
      box.append(element("div", { class: "formula" }, document.importNode(math, true)));
    }
    if (long) box.append(element("p", { class: "hint" }, `These are too long for a page: bricard show ${run.name} prints them.`));
    else if (zeros > 0) box.append(element("p", { class: "hint" }, lines.length > 0 ? `The other entries (${zeros}) are zero.` : "All entries are zero."));
    place.append(box);
  }
}

function facts(run) {
  const left = element("div");
  if (run.source) {
    left.append(element("h2", {}, run.source.file), coloured(run.source.text, run.words));
  }
  const right = element("div");
  const add = (heading, rows) => {
    if (rows.length > 0) right.append(element("h2", {}, heading), table(rows));
  };
  right.append(element("h2", {}, "Command"), command(run.command));
  add("Parameters", run.parameters.map((p) => [p.name, withUnit(p.value, p.unit), p.docs]));
  add("Start", run.start.map((c) => [c.name, withUnit(c.value, c.unit), `rate ${withUnit(c.rate, c.unit && `${c.unit}/s`)}`]));
  add("Method", run.settings);
  add("Summary", run.summary);
  document.getElementById("facts").append(left, right);
}
