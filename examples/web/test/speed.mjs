// How many times as long as native code the module takes, once it is warm: the shortest of
// many runs each. A busy machine makes the numbers larger, so no test depends on them.
import { Mechanism } from "bricard-engine";
import { CASES, run } from "./cases.mjs";
import { native } from "./native.mjs";

const RUNS = 40;

const natively = native(RUNS);
for (const [place, each] of CASES.entries()) {
  const engine = await Mechanism.load();
  let shortest = Infinity;
  for (let i = 0; i < RUNS; i++) {
    const begin = performance.now();
    run(engine, each);
    shortest = Math.min(shortest, (performance.now() - begin) / 1000);
  }
  const { seconds } = natively[place];
  const [here, there] = [shortest, seconds].map((time) => `${(time * 1000).toFixed(2)} ms`);
  console.log(`${each.method}: ${here}, native ${there}, ratio ${(shortest / seconds).toFixed(2)}`);
}
