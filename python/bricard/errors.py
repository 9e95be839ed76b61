"""What can go wrong, in the words of the command and of the runtime."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional

import numpy as np

if TYPE_CHECKING:
    from .result import Result


class BricardError(Exception):
    """Anything that bricard refuses."""


class CompileError(BricardError):
    """The command or the compiler is missing, or could not do its work."""


class DescriptionError(BricardError):
    """A description is wrong: what, where, and what to write instead."""


class UnknownName(BricardError, KeyError):
    """There is no parameter, input, coordinate or mechanism of a name."""

    def __str__(self) -> str:
        # A KeyError would show the message in quotes.
        return str(self.args[0]) if self.args else ""


class InvalidValue(BricardError, ValueError):
    """A value makes no sense: not finite, of the wrong length, an option out of range."""


class AssemblyError(BricardError):
    """No consistent initial state was found."""


class SimulationError(BricardError):
    """A motion could not go on.

    `t` is when (s), `q` and `v` are the last good state, and `result` holds what was
    computed before, if it was a simulation that failed.
    """

    def __init__(
        self,
        message: str,
        t: Optional[float] = None,
        q: Optional[np.ndarray] = None,
        v: Optional[np.ndarray] = None,
        result: Optional["Result"] = None,
    ):
        super().__init__(message)
        self.t = t
        self.q = q
        self.v = v
        self.result = result
