// The same runs in native code.
import { execFileSync } from "node:child_process";
import { CASES } from "./cases.mjs";

/** Of each case the states, as bits, and the shortest time (s) of so many runs. */
export function native(repeat) {
  const input = JSON.stringify(CASES.map((each) => ({ ...each, repeat })));
  const answers = execFileSync(process.env.NATIVE, { input, maxBuffer: 1 << 28 });
  return answers.toString().trim().split("\n").map((line) => JSON.parse(line));
}
