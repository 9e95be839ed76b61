// What the package and its module say where they refuse something, on the page of messages.
//
// The page shows what is really said; with BRICARD_BLESS=1 it is written from that. Said have
// to be the sentences of the wrapper's and the session's sources.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { Mechanism, MechanismError } from "bricard-engine";

const PAGE = join(process.env.ROOT, "docs/messages.md");
const SOURCES = ["wasm/js/index.js", "wasm/src/session.rs", "wasm/src/session_run.rs"];

const INTRODUCTION = `\
These are the messages of \`MechanismError\`, about the engine of \`examples/web\`; \
\`assembled\` is another one, after \`assemble()\`, and \`wasm\` are the functions of the module, \
for programs that do without \`index.js\`. Starts and runs are refused in the words of [the runtime](#starts-and-runs).`;

// What only a mechanism brings about that is much larger, or turns much faster, than any of
// the library.
const NEVER = [
  "more happens in one step than there is room for",
  "numbers are more than the module has room for",
  "the description of the mechanism is too long",
  "a row has more numbers than there is room for",
];

const CALLS = [
  "engine.set({ mass: 1 })",
  'engine.set({ ms: "1" })',
  "engine.set({ ms: NaN })",
  'engine.method("euler")',
  'engine.settings({ form: "other" })',
  'engine.settings({ stabilisation: "none at all" })',
  "engine.settings({ stabilisation: { alpha: -1, beta: 1 } })",
  "engine.assemble({ held: { angle: 1 } })",
  "engine.advance(1)",
  "engine.state",
  'assembled.run({ until: 1, every: 0.1, columns: ["speed"] })',
  "assembled.state = { t: 0, q: [1], v: [1] }",
  "new Mechanism({ exports: { version: () => 1 } })",
  "wasm.set_parameter(0, NaN)",
  "wasm.set_parameter(9, 1)",
  "wasm.set_input(9, 1)",
  "wasm.begin(9, 0, 1)",
  "wasm.start(9)",
  "wasm.fixed(9, 0.1)",
  "wasm.settings(9, 0, 0, 0, 0)",
  "wasm.settings(0, 9, 0, 0, 0)",
  "wasm.place(9, 0)",
  "wasm.run(1, 0.1, 1 << 20, 0)",
];

/** The functions of a module, whose failures are thrown. */
async function functions() {
  const bytes = readFileSync(new URL(import.meta.resolve("bricard-engine/mechanism.wasm")));
  const { instance } = await WebAssembly.instantiate(bytes, {});
  const { memory, text, length, assemble } = instance.exports;
  assert.equal(assemble(), 0);
  const call = (name) => (...words) => {
    if (instance.exports[name](...words) === 0) return;
    throw new MechanismError(new TextDecoder().decode(new Uint8Array(memory.buffer, text(), length())));
  };
  return Object.fromEntries(Object.keys(instance.exports).map((name) => [name, call(name)]));
}

/** The sentences of the sources, each as what stands between its placeholders. */
function sentences() {
  const patterns = [/new MechanismError\(\s*(?:`([^`]*)`|"([^"]*)")/g, /fail\(&(?:format_args!\()?"([^"]*)"/g];
  const found = SOURCES.flatMap((path) => {
    const text = readFileSync(join(process.env.ROOT, path), "utf8");
    return patterns.flatMap((pattern) => [...text.matchAll(pattern)].map(([, one, other]) => one ?? other));
  });
  const words = (text) => text.split(/\s+/).filter((word) => /[a-z]/i.test(word));
  const parts = found.map((text) => text.split(/\$?\{[^}]*\}/));
  return parts.filter((pieces) => words(pieces.join(" ")).length > 2);
}

/** Whether a text has some pieces, one behind the other. */
function holds(text, pieces) {
  let at = 0;
  return pieces.every((piece) => {
    const place = text.indexOf(piece, at);
    at = place + piece.length;
    return place >= 0;
  });
}

/** A message in a cell: code stays as it is, no other sign means anything to Markdown. */
function prose(text) {
  const plain = (part) => part.replace(/[|*_<>[\]\\~]/g, "\\$&");
  return text.split("`").map((part, place) => (place % 2 ? part : plain(part))).join("`");
}

/** Holds a section of the page against a text, or writes it there. */
function hold(heading, text) {
  const page = readFileSync(PAGE, "utf8");
  const [before, rest] = page.split(`\n## ${heading}\n`);
  const end = rest.indexOf("\n## ");
  const after = end < 0 ? "" : rest.slice(end);
  const wanted = `${before}\n## ${heading}\n\n${text.trim()}\n${after}`;
  if (process.env.BRICARD_BLESS) writeFileSync(PAGE, wanted);
  else assert.equal(page, wanted, "BRICARD_BLESS=1 rewrites it");
}

test("every refusal is on the page of messages", async () => {
  const known = {
    Mechanism,
    engine: await Mechanism.load(),
    assembled: (await Mechanism.load()).assemble(),
    wasm: await functions(),
  };
  const said = CALLS.map((call) => {
    const act = new Function(...Object.keys(known), call.startsWith("assembled.state") ? call : `return ${call}`);
    try {
      act(...Object.values(known));
    } catch (error) {
      assert.ok(error instanceof MechanismError, `${call}: ${error}`);
      return [call, error.message];
    }
    assert.fail(`${call} is not refused`);
  });
  const is_said = (pieces) => said.some(([, message]) => holds(message, pieces));
  const is_never = (pieces) => NEVER.some((text) => pieces.join("").includes(text));
  const wrong = sentences().filter((pieces) => is_said(pieces) === is_never(pieces));
  assert.deepEqual(wrong, [], "never said, or said after all");
  const rows = said.map(([call, message]) => `| ${prose(message)} | \`${call}\` |`);
  const table = ["| message | brought about by |", "|---|---|", ...rows].join("\n");
  hold("JavaScript", `${INTRODUCTION}\n\n${table}`);
});
