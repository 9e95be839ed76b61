"""A mechanism in the library: calls, with errors as exceptions."""

from __future__ import annotations

import ctypes
import threading
from typing import Callable, Dict, List, NamedTuple, Optional, Set, Tuple

import numpy as np

from . import _abi
from .errors import AssemblyError, BricardError, InvalidValue, SimulationError, UnknownName


_IN_TURN = (
    "the function of an input asks its own mechanism, which asks the function in turn; let it "
    "ask a copy: `model = m.copy()` before `m.drive`"
)


class Law:
    """A function that an input follows, as the library calls it."""

    def __init__(self, function: Callable[..., float], takes_state: bool, sizes: Tuple[int, int]):
        self.function, self.takes_state = function, takes_state
        self.n, self.m = sizes[0], sum(sizes)
        #: What it has raised: it must not cross the library, and comes out when that returns.
        self.raised: List[BaseException] = []
        self.callback = _abi.Law(self.value)
        #: The threads in which it is at work.
        self._at_work: Set[int] = set()

    def value(self, _user, t, q, v, out) -> int:
        if self.raised:
            # A call that fails anyway asks once more here and there.
            return 1
        thread = threading.get_ident()
        if thread in self._at_work:
            self.raised.append(BricardError(_IN_TURN))
            return 1
        self._at_work.add(thread)
        try:
            state = (np.array(q[: self.n]), np.array(v[: self.m])) if self.takes_state else ()
            out[0] = self.function(t, *state)
            return 0
        except BaseException as error:
            self.raised.append(error)
            return 1
        finally:
            self._at_work.discard(thread)


class Quantity(NamedTuple):
    """What a description names."""

    name: str
    unit: str
    docs: str


class Handle:
    """Owns one mechanism of a library, and frees it."""

    def __init__(self, table: "_abi.Interface", pointer: Optional[int] = None):
        self.table = table
        self._pointer = _abi.Handle(pointer)
        #: Functions of inputs, which must live as long as they may be called.
        self.laws: Dict[int, Law] = {}
        if pointer is None and table.create(ctypes.byref(self._pointer)) != _abi.OK:
            raise BricardError("the mechanism could not be made")

    def __del__(self) -> None:
        # When the interpreter ends, the handle may be all that is left.
        if getattr(self, "_pointer", None):
            self.table.free(ctypes.byref(self._pointer))

    def clone(self) -> "Handle":
        """A copy, which goes on to the same bits."""
        pointer = _abi.Handle()
        self.call(self.table.clone, ctypes.byref(pointer))
        copy = Handle(self.table, pointer.value)
        copy.laws = dict(self.laws)
        return copy

    def message(self) -> str:
        """Why the last call failed that did."""
        return self.table.message(self._pointer).decode()

    def failed_at(self) -> Optional[float]:
        """When the last motion failed (s)."""
        t = ctypes.c_double()
        status = self.table.failed_at(self._pointer, ctypes.byref(t))
        return t.value if status == _abi.OK else None

    def run_status(self, function, *arguments) -> int:
        """Calls a function of the table; its status."""
        for law in self.laws.values():
            law.raised.clear()
        return function(self._pointer, *arguments)

    def call(self, function, *arguments) -> int:
        """Calls a function of the table; an exception if it fails."""
        status = self.run_status(function, *arguments)
        if status < 0:
            raise self.error(status)
        return status

    def error(self, status: int) -> BaseException:
        """The exception of a failed call: what a function of an input has raised, if one has."""
        message = self.message()
        for law in self.laws.values() if status == _abi.CALLBACK else ():
            if law.raised:
                return law.raised.pop()
        if status == _abi.NAME:
            return UnknownName(message)
        if status == _abi.ASSEMBLY:
            return AssemblyError(message)
        if status in (_abi.RUN, _abi.CALLBACK):
            t, q, v = self.state_if_any()
            return SimulationError(message, self.failed_at(), q, v)
        if status in (_abi.LENGTH, _abi.INDEX, _abi.NOT_FINITE, _abi.ARGUMENT):
            return InvalidValue(message)
        return BricardError(message)

    def number(self, function, *arguments) -> int:
        """A size that a function tells."""
        size = ctypes.c_size_t()
        self.call(function, *arguments, ctypes.byref(size))
        return size.value

    def quantities(self, which: int) -> Tuple[Quantity, ...]:
        """The entries of a list."""
        table, found = self.table, []
        for index in range(self.number(table.count, which)):
            texts = (table.name, table.unit, table.docs)
            entry = [text(self._pointer, which, index).decode() for text in texts]
            found.append(Quantity(*entry))
        return tuple(found)

    def find(self, which: int, name: str) -> int:
        """The place of a name in a list."""
        if not isinstance(name, str):
            raise UnknownName(f"a name is a text, not {name!r}")
        if "\0" in name:
            raise UnknownName(f"there is no {name!r}")
        return self.number(self.table.find, which, name.encode())

    def sizes(self) -> Tuple[int, int]:
        """How many coordinates there are, and how many states of the first order."""
        count = self.table.count
        return self.number(count, _abi.COORDINATES), self.number(count, _abi.STATES)

    def state_if_any(self):
        """Time, coordinates and velocities; `None` three times if there is no state."""
        n, behind = self.sizes()
        t, q, v = ctypes.c_double(), np.zeros(n), np.zeros(n + behind)
        pointers = ctypes.byref(t), _abi.doubles(q), _abi.doubles(v)
        if self.table.state(self._pointer, *pointers, len(v)) != _abi.OK:
            return None, None, None
        return t.value, q, v

    def project(self, t: float, q: np.ndarray, v: np.ndarray) -> None:
        """Puts a state, in arrays of its own, onto the constraints."""
        arrays = _abi.doubles(q), _abi.doubles(v)
        self.call(self.table.project, t, *arrays, len(v))

    def shapes(self, t: float, q: np.ndarray, v: np.ndarray) -> List[tuple]:
        """The picture at a state: a kind, points, and a radius."""
        point = point_of(t, q, v)
        at = ctypes.byref(point)
        size = self.number(self.table.draw, at, None, 0)
        numbers = np.zeros(size)
        self.number(self.table.draw, at, _abi.doubles(numbers), size)
        shapes, next_ = [], 0
        while next_ < size:
            kind, count = int(numbers[next_]), int(numbers[next_ + 1])
            next_ += 2
            points = numbers[next_ : next_ + 3 * count].reshape(count, 3)
            next_ += 3 * count
            radius = None
            if kind == _abi.CIRCLE:
                radius = float(numbers[next_])
                next_ += 1
            shapes.append((kind, points, radius))
        return shapes


def point_of(t: float, q: np.ndarray, v: np.ndarray) -> "_abi.Point":
    """A state for the library; the arrays have to outlive it."""
    point = _abi.Point(t, _abi.doubles(q), _abi.doubles(v), len(v))
    point.arrays = q, v
    return point
