// The motions of `boundaries` in Node, given the package: medians of what they take, in
// microseconds.
import { performance } from "node:perf_hooks";
import { pathToFileURL } from "node:url";

const { Mechanism } = await import(pathToFileURL(`${process.argv[2]}/index.js`));
const mechanism = await Mechanism.load();
const steps = 200;

function median(once) {
  const times = Array.from({ length: 101 }, () => {
    const begun = performance.now();
    once();
    return (performance.now() - begun) * 1e3;
  });
  return times.sort((a, b) => a - b)[50];
}

const step = median(() => {
  mechanism.assemble();
  for (let i = 1; i <= steps; i++) mechanism.advance(i * 1e-3);
});
const span = median(() => mechanism.assemble().advance(8));
console.log(`step ${step / steps}\nspan ${span}`);
