"""Simulates the mechanism for ten seconds: a row each half second."""

from . import mechanism

run = mechanism.simulate(until=10, every=0.5)
names = [quantity.name for quantity in (*mechanism.coordinates, *mechanism.states)]
print(f"{'t':>6}", *(f"{name:>12}" for name in names))
for t, *values in zip(run.t, *(run[name] for name in names)):
    print(f"{t:6.2f}", *(f"{value:12.6f}" for value in values))
print(run.summary if mechanism.constraints else f"{run.summary.steps} steps")
