"""Closed-loop mechanisms, compiled from energies, simulated through singular positions.

    >>> import bricard
    >>> m = bricard.library.slider_crank
    >>> run = m.simulate(until=8, rtol=1e-10, every=0.01)
    >>> run["q1"][-1], len(run.passages)

A `Mechanism` is made of a description, which the ``bricard`` command compiles behind the
scenes and keeps. Everything is in SI units.
"""

from . import library
from .errors import (
    AssemblyError,
    BricardError,
    CompileError,
    DescriptionError,
    InvalidValue,
    SimulationError,
    UnknownName,
)
from .mechanism import Guess, Mechanism, Quantity, Slopes, State, guess
from .result import Event, Passage, Result, Summary

__version__ = "0.1.0"

__all__ = [
    "AssemblyError",
    "BricardError",
    "CompileError",
    "DescriptionError",
    "Event",
    "Guess",
    "InvalidValue",
    "Mechanism",
    "Passage",
    "Quantity",
    "Result",
    "SimulationError",
    "Slopes",
    "State",
    "Summary",
    "UnknownName",
    "guess",
    "library",
]
