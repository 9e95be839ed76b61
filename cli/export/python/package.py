"""ABOUT

    >>> import PACKAGE
    >>> run = PACKAGE.mechanism.simulate(until=8, every=0.01)
    >>> run.t[-1], run.q[-1]

`python -m PACKAGE` simulates it for ten seconds. Compiled by bricard VERSION; neither that
nor a compiler is needed here. Everything is in SI units.
"""

from pathlib import Path

from ._bricard import (
    AssemblyError,
    BricardError,
    Guess,
    InvalidValue,
    Mechanism,
    Result,
    SimulationError,
    State,
    UnknownName,
    guess,
)

#: The mechanism, with the parameters and the start of its description.
mechanism = Mechanism.from_library(Path(__file__).parent / "LIBRARY")

#: The description that it was compiled from.
source = (Path(__file__).parent / "MODULE.mech").read_text(encoding="utf-8")

__version__ = "0.1.0"

__all__ = [
    "AssemblyError",
    "BricardError",
    "Guess",
    "InvalidValue",
    "Mechanism",
    "Result",
    "SimulationError",
    "State",
    "UnknownName",
    "guess",
    "mechanism",
    "source",
]
