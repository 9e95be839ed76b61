"""A table of what boundaries cost, from lines `boundary motion microseconds`."""

import statistics
import sys
from collections import defaultdict

times = defaultdict(list)
for line in open(sys.argv[1], encoding="utf-8"):
    boundary, motion, taken = line.split()
    times[boundary, motion].append(float(taken))

#: What is compared, with what, and what it may cost: a factor, and milliseconds more.
ROWS = [
    ("C: a step of 1 ms", ("c", "step"), ("rust", "step"), "Rust", 1.05, 0),
    ("C: 8 s, a row each 10 ms", ("c", "run"), ("rust", "run"), "Rust", 1.05, 0),
    ("FMU (FMI 3.0): a step of 1 ms", ("fmu", "step"), ("rust", "step"), "Rust", 1.10, 0),
    ("Python: 8 s, a row each 10 ms", ("python", "full"), ("c", "full"), "C", 1.20, 1),
    ("WebAssembly in Node: a step of 1 ms", ("node", "step"), ("rust", "step"), "Rust", 2.0, 0),
    ("WebAssembly in Node: 8 s", ("node", "span"), ("rust", "span"), "Rust", 2.0, 0),
]

print("| boundary | takes (µs) | the same in | takes (µs) | ratio | at most |")
print("|---|---|---|---|---|---|")
missed = 0
for name, boundary, base, language, factor, more in ROWS:
    # Ratios within a round, of which the middle one counts.
    ratio = statistics.median(a / b for a, b in zip(times[boundary], times[base]))
    taken, given = statistics.median(times[boundary]), statistics.median(times[base])
    most = factor + 1e3 * more / given
    missed += ratio > most
    bound = f"{factor:g}" + (f" + {more} ms" if more else "")
    print(f"| {name} | {taken:.2f} | {language} | {given:.2f} | {ratio:.2f} | {bound} |")
sys.exit(1 if missed else 0)
