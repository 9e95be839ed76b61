// The same runs in native code.
import { execFileSync } from "node:child_process";
import { CASES } from "./cases.mjs";

/** Of each case the states, as bits, and the shortest time (s). */
export function native() {
  const input = JSON.stringify(CASES);
  const answers = execFileSync(process.env.NATIVE, { input, maxBuffer: 1 << 28 });
  return answers.toString().trim().split("\n").map((line) => JSON.parse(line));
}
