// Simulates the mechanism for ten seconds: `node example.mjs`.
import { Mechanism } from "./index.js";

// Parameters have the values of the description; `mechanism.set({ … })` changes them.
const mechanism = await Mechanism.load();

// The guesses of `start` are moved until the constraints hold.
mechanism.assemble();

const columns = mechanism.coordinates.map(({ name }) => name.padStart(12));
console.log(["     t", ...columns].join(" "));
for (let row = 0; row <= 20; row++) {
  const { t, q } = mechanism.advance(row / 2).state;
  console.log([t.toFixed(2).padStart(6), ...q.map((x) => x.toFixed(6).padStart(12))].join(" "));
}
