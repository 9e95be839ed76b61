"""Simulates the mechanism for ten seconds: a row each half second."""

from . import mechanism

run = mechanism.simulate(until=10, every=0.5)
print(f"{'t':>6}", *(f"{quantity.name:>12}" for quantity in mechanism.coordinates))
for t, q in zip(run.t, run.q):
    print(f"{t:6.2f}", *(f"{value:12.6f}" for value in q))
print(run.summary)
