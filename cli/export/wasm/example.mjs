// Simulates the mechanism for ten seconds: `node example.mjs`.
import { Mechanism } from "./index.js";

// Parameters have the values of the description; `mechanism.set({ … })` changes them.
const mechanism = await Mechanism.load();

// The guesses of `start` are moved until the constraints hold.
mechanism.assemble();

const quantities = [...mechanism.coordinates, ...mechanism.states];
const columns = quantities.map(({ name }) => name.padStart(12));
console.log(["     t", ...columns].join(" "));
for (let row = 0; row <= 20; row++) {
  const { t, q, states } = mechanism.advance(row / 2).state;
  const numbers = [...q, ...states].map((x) => x.toFixed(6).padStart(12));
  console.log([t.toFixed(2).padStart(6), ...numbers].join(" "));
}
