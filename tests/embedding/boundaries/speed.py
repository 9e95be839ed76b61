"""The run of `boundaries` in Python: the median of what it takes, in microseconds."""

import statistics
import time

from slider_crank import mechanism


def once() -> float:
    begun = time.perf_counter()
    mechanism.simulate(until=8, rtol=1e-9, every=0.01)
    return (time.perf_counter() - begun) * 1e6


print("full", statistics.median(once() for _ in range(101)))
