"""Mechanisms: what they are, where they can be, how they move."""

from __future__ import annotations

import ctypes
import inspect
import os
import re
import tempfile
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _abi, _compile
from ._handle import Handle, Law, Quantity, point_of
from ._run import Plan, run
from .errors import InvalidValue
from .result import Result

Numbers = Union[Sequence[float], np.ndarray]
Given = Union[float, Callable[..., float]]


class State(NamedTuple):
    """Time (s), coordinates and velocities (SI); of many times, a row for each. States of
    the first order stand behind the velocities."""

    t: Any
    q: np.ndarray
    v: np.ndarray


class Slopes(NamedTuple):
    """Derivatives of the accelerations, a row for each: by coordinates, by velocities (and
    states of the first order), by inputs."""

    q: np.ndarray
    v: np.ndarray
    u: np.ndarray


class Guess(float):
    """A value of the start that gives way to the constraints; others are held."""


def guess(value: float) -> Guess:
    """A value that is near enough: ``start={"q1": 0.8, "q2": bricard.guess(0.7)}``."""
    return Guess(value)


class Mechanism:
    """A mechanism compiled from a description.

    ``Mechanism("four_bar.mech")`` compiles a file, unless that was done before;
    `from_text` a description in a string; `from_library` loads what
    ``bricard export --to c`` has made, and needs neither the command nor a compiler.

    A mechanism holds parameters and inputs; `simulate` leaves it as it is. It may be used
    from several threads.
    """

    def __init__(self, path: Union[str, "os.PathLike[str]"], *, _is_library: bool = False):
        path = Path(path)
        if not _is_library:
            if path.suffix != ".mech":
                raise InvalidValue(
                    f"{path} is no description: those are files that end in .mech; "
                    "mechanisms of the library are bricard.library.NAME, and texts are read "
                    "by Mechanism.from_text"
                )
            path = _compile.compiled(os.fspath(path.resolve()))
        self._lock = threading.Lock()
        #: It is only copied and asked what it has, so that it is never at work.
        self._handle = Handle(_compile.interface(path))
        #: Copies of it that are at nobody's work.
        self._idle: List[Handle] = []
        lists = (
            _abi.MECHANISM,
            _abi.COORDINATES,
            _abi.PARAMETERS,
            _abi.INPUTS,
            _abi.OUTPUTS,
            _abi.EVENTS,
            _abi.CONSTRAINTS,
            _abi.STATES,
        )
        found = [self._handle.quantities(which) for which in lists]
        #: The name after `mechanism`, and its documentation.
        self.name: str = found[0][0].name
        self.docs: str = found[0][0].docs
        #: What there is: each with name, unit and docs.
        self.coordinates: Tuple[Quantity, ...] = found[1]
        self.parameter_quantities: Tuple[Quantity, ...] = found[2]
        self.inputs: Tuple[Quantity, ...] = found[3]
        self.outputs: Tuple[Quantity, ...] = found[4]
        self.events: Tuple[Quantity, ...] = found[5]
        self.constraints: Tuple[Quantity, ...] = found[6]
        #: States of the first order, which stand behind the velocities.
        self.states: Tuple[Quantity, ...] = found[7]
        #: How many coordinates, velocities and states, and constraint equations there are.
        self.n: int = len(self.coordinates)
        self.m: int = self.n + len(self.states)
        self.r: int = len(self.constraints)

    @classmethod
    def from_text(cls, text: str, name: str = "mechanism") -> "Mechanism":
        """Compiles a description in a string; `name` is what messages call its file."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"{name}.mech"
            path.write_text(text, encoding="utf-8")
            return cls(path)

    @classmethod
    def from_library(cls, path: Union[str, "os.PathLike[str]"]) -> "Mechanism":
        """Loads a shared library that was compiled before."""
        return cls(path, _is_library=True)

    def __repr__(self) -> str:
        names = ", ".join(quantity.name for quantity in self.coordinates)
        return f"<Mechanism {self.name}: {names}; {self.r} constraint equations>"

    def copy(self) -> "Mechanism":
        """Another one, with the same parameters and inputs."""
        copy = object.__new__(type(self))
        copy.__dict__.update(self.__dict__)
        copy._lock = threading.Lock()
        copy._handle, copy._idle = self._clone(), []
        return copy

    def _clone(self) -> Handle:
        with self._lock:
            return self._handle.clone()

    @contextmanager
    def _lend(self) -> Iterator[Handle]:
        """A copy that does nothing else meanwhile: several threads may ask at once, and the
        function of an input its own mechanism."""
        with self._lock:
            idle = self._idle
            handle = idle.pop() if idle else self._handle.clone()
        try:
            yield handle
        finally:
            idle.append(handle)

    # ---- parameters and inputs ---------------------------------------------------------

    @property
    def parameters(self) -> Dict[str, float]:
        """The parameters by name; `set` changes them."""
        values = {}
        with self._lock:
            for index, quantity in enumerate(self.parameter_quantities):
                value = ctypes.c_double()
                table = self._handle.table
                self._handle.call(table.parameter, index, ctypes.byref(value))
                values[quantity.name] = value.value
        return values

    def set(self, parameters: Optional[Mapping[str, float]] = None, **more: float) -> None:
        """Changes parameters: ``m.set(L1=0.4)``, ``m.set({"theta[0]": 1})``; none if one of
        them is refused."""
        with self._lock:
            # A copy is changed and taken, so that what is refused changes nothing.
            handle = self._handle.clone()
            _set_parameters(handle, {**(parameters or {}), **more})
            self._handle, self._idle = handle, []

    def drive(self, inputs: Mapping[str, Optional[Given]]) -> None:
        """Holds inputs at numbers, or lets them follow functions ``f(t)`` or
        ``f(t, q, v)``; `None` returns one to the law of the description. If one is refused,
        none is changed. A function that asks a mechanism for masses or forces asks a copy,
        which doesn't ask the function in turn."""
        with self._lock:
            handle = self._handle.clone()
            _drive(handle, inputs)
            self._handle, self._idle = handle, []

    # ---- where it can be ---------------------------------------------------------------

    def assemble(
        self, start: Optional[Mapping[str, float]] = None, t: float = 0.0
    ) -> State:
        """A state on the constraints, with what `start` and the description hold.

        Names are coordinates, velocities ``"der(q1)"``, or states of the first order; a
        `guess` gives way.
        """
        handle = self._clone()
        _begin(handle, start, t)
        return State(*handle.state_if_any())

    def project(self, q: Numbers, v: Optional[Numbers] = None, t: float = 0.0) -> State:
        """The state on the constraints next to one that is near them."""
        q, v = self._state(q, v)
        with self._lend() as handle:
            handle.project(float(t), q, v)
        return State(float(t), q, v)

    # ---- the equations of motion: M a + r = p1, A a = p2 ---------------------------------
    # With states of the first order, n is m: accelerations have the rates of the states
    # behind them.

    def mass_matrix(self, q: Numbers, v: Optional[Numbers] = None, t: float = 0.0) -> np.ndarray:
        """`M`, n × n."""
        return self._evaluate(_abi.MASS, q, v, t).reshape(self.m, self.m)

    def force(self, q: Numbers, v: Optional[Numbers] = None, t: float = 0.0) -> np.ndarray:
        """`p1`: applied forces, and what velocities make of the masses."""
        return self._evaluate(_abi.FORCE, q, v, t)

    def jacobian(self, q: Numbers, t: float = 0.0) -> np.ndarray:
        """`A`, r × n: the constraints' derivatives by the coordinates."""
        return self._evaluate(_abi.JACOBIAN, q, None, t).reshape(self.r, self.m)

    def bias(self, q: Numbers, v: Numbers, t: float = 0.0) -> np.ndarray:
        """`p2`: what the constraints demand of ``A a``."""
        return self._evaluate(_abi.BIAS, q, v, t)

    def residual(self, q: Numbers, t: float = 0.0) -> np.ndarray:
        """`g`: how far a position is off the constraints."""
        return self._evaluate(_abi.RESIDUAL, q, None, t)

    def velocity_residual(self, q: Numbers, v: Numbers, t: float = 0.0) -> np.ndarray:
        """``A v + b``: how far velocities are off the constraints."""
        return self._evaluate(_abi.RATE, q, v, t)

    def acceleration(self, q: Numbers, v: Numbers, t: float = 0.0) -> np.ndarray:
        """`a`, also in singular positions that are passed."""
        return self._evaluate(_abi.ACCELERATION, q, v, t)

    def reactions(self, q: Numbers, v: Numbers, t: float = 0.0) -> np.ndarray:
        """`r`: the generalized reaction forces of the constraints."""
        return self._evaluate(_abi.REACTION, q, v, t)

    def output(self, q: Numbers, v: Optional[Numbers] = None, t: float = 0.0) -> Dict[str, float]:
        """The outputs by name."""
        values = self._evaluate(_abi.OUTPUT, q, v, t)
        return {quantity.name: float(x) for quantity, x in zip(self.outputs, values)}

    def energy(self, q: Numbers, v: Optional[Numbers] = None, t: float = 0.0) -> Dict[str, float]:
        """Kinetic and potential energy, the balance of both (J), and the power (W)."""
        values = self._evaluate(_abi.ENERGY, q, v, t)
        return dict(zip(("kinetic", "potential", "balance", "power"), map(float, values)))

    def rhs(self, t: float, y: Numbers) -> np.ndarray:
        """The derivative of ``y = [q, v]``, for solvers such as
        ``scipy.integrate.solve_ivp``. It knows no projection: errors of such a solver
        lead off the constraints."""
        y = np.asarray(y, dtype=float)
        if y.shape != (self.n + self.m,):
            raise InvalidValue(f"y holds q and v, {self.n + self.m} numbers, not {y.shape}")
        v = y[self.n :]
        return np.concatenate([v[: self.n], self.acceleration(y[: self.n], v, t)])

    def slopes(self, q: Numbers, v: Numbers, t: float = 0.0) -> Slopes:
        """How accelerations change with coordinates, velocities and inputs: exact, by the
        derived equations. Refused where a mechanism has none, since the code would be too
        long, and near singular positions."""
        width = self.n + self.m + len(self.inputs)
        matrix = self._evaluate(_abi.SLOPE, q, v, t).reshape(-1, width)
        return Slopes(*np.split(matrix, [self.n, self.n + self.m], axis=1))

    def _state(self, q: Numbers, v: Optional[Numbers]) -> Tuple[np.ndarray, np.ndarray]:
        """Arrays of a state, which belong to nobody else."""
        arrays = []
        v = np.zeros(self.m) if v is None else v
        for name, values, size in (("q", q, self.n), ("v", v, self.m)):
            try:
                array = np.array(values, dtype=float)
            except (TypeError, ValueError) as error:
                raise InvalidValue(f"{name} has to be numbers: {error}") from None
            if array.shape != (size,):
                raise InvalidValue(f"{name} has {size} numbers, not the shape {array.shape}")
            arrays.append(array)
        return arrays[0], arrays[1]

    def _evaluate(self, which: int, q: Numbers, v: Optional[Numbers], t: float) -> np.ndarray:
        q, v = self._state(q, v)
        with self._lend() as handle:
            out = np.zeros(handle.number(handle.table.size, which))
            point = point_of(float(t), q, v)
            at = ctypes.byref(point)
            handle.call(handle.table.evaluate, which, at, _abi.doubles(out), len(out))
        return out

    # ---- motion --------------------------------------------------------------------------

    def simulate(
        self,
        until: float,
        *,
        rtol: Optional[float] = None,
        atol: Optional[float] = None,
        step: Optional[float] = None,
        method: Optional[str] = None,
        every: Optional[float] = None,
        parameters: Optional[Mapping[str, float]] = None,
        start: Union[Mapping[str, float], State, None] = None,
        inputs: Optional[Mapping[str, Optional[Given]]] = None,
        t0: float = 0.0,
        form: str = "reduced",
        stabilisation: Union[str, Tuple[str, float, float]] = "projection",
        keep_energy: bool = False,
        reactions: bool = True,
        most_steps: Optional[int] = None,
        on_event: Optional[Callable[[str, State], Any]] = None,
    ) -> Result:
        """Simulates from `t0` to `until` (s).

        rtol, atol
            accepted errors of a step [1e-9; atol: that of rtol]
        step
            a fixed step (s) instead
        method
            "dop853" [default], "dp5", "rk4" [with `step`], "radau5", "radau9"
        every
            distance of the rows (s) [a row after each step]
        parameters, inputs
            as `set` and `drive`, for this run alone
        start
            as `assemble`; or a `State` to begin at, such as the end of another run
        form, stabilisation, keep_energy
            as the options of ``bricard simulate``;
            ``stabilisation=("baumgarte", alpha, beta)``
        reactions
            whether rows hold the reaction forces
        on_event
            is told the name and the `State` of each event; what is true ends the run there

        Ctrl-C ends a run with KeyboardInterrupt. A `SimulationError` has the rows so far.
        """
        handle = self._clone()
        _set_parameters(handle, parameters or {})
        _drive(handle, inputs or {})
        _choose(handle, method, step, rtol, atol, form, stabilisation, keep_energy, most_steps)
        if isinstance(start, State):
            q, v = self._state(start.q, start.v)
            arrays = _abi.doubles(q), _abi.doubles(v)
            handle.call(handle.table.set_state, float(start.t), *arrays, self.m)
        else:
            _begin(handle, start, t0)
        if every is not None and not (np.isfinite(every) and every > 0):
            raise InvalidValue(f"every has to be a positive number of seconds, not {every}")
        plan = Plan(float(until), every, reactions, on_event)
        return run(self, handle, plan)


def _set_parameters(handle: Handle, parameters: Mapping[str, float]) -> None:
    places = [(handle.find(_abi.PARAMETERS, name), name) for name in parameters]
    for index, name in places:
        handle.call(handle.table.set_parameter, index, _number(parameters[name], name))


def _number(value: Any, name: str) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise InvalidValue(f"`{name}` has to be a number, not {value!r}") from None


def _drive(handle: Handle, inputs: Mapping[str, Optional[Given]]) -> None:
    for name, law in inputs.items():
        index = handle.find(_abi.INPUTS, name)
        if law is None:
            handle.call(handle.table.release_input, index)
            handle.laws.pop(index, None)
        elif callable(law):
            followed = _law(name, law, handle.sizes())
            handle.call(handle.table.drive_input, index, followed.callback, None)
            handle.laws[index] = followed
        else:
            handle.call(handle.table.hold_input, index, _number(law, name))
            handle.laws.pop(index, None)


def _law(name: str, law: Callable[..., float], sizes: Tuple[int, int]) -> Law:
    """A function that the library calls at the stages of steps."""
    try:
        parameters = inspect.signature(law).parameters.values()
        wanted = [p for p in parameters if p.default is p.empty and p.kind <= p.POSITIONAL_OR_KEYWORD]
        count = len(wanted)
    except (TypeError, ValueError):
        count = 1
    if count not in (1, 3):
        raise InvalidValue(
            f"the function of the input `{name}` takes (t) or (t, q, v), not {count} arguments"
        )
    return Law(law, count == 3, sizes)


_VELOCITY = re.compile(r"\s*der\((.*)\)\s*")


def _begin(handle: Handle, start: Optional[Mapping[str, float]], t: float) -> None:
    """Assembles a start."""
    for name, value in (start or {}).items():
        velocity = _VELOCITY.fullmatch(name) if isinstance(name, str) else None
        n, behind = handle.sizes()
        states = [state.name for state in handle.quantities(_abi.STATES)] if behind else []
        if name in states:
            velocity, index = True, n + states.index(name)
        else:
            index = handle.find(_abi.COORDINATES, velocity.group(1) if velocity else name)
        held = not isinstance(value, Guess)
        number = _number(value, name)
        handle.call(handle.table.set_start, index, bool(velocity), number, held)
    handle.call(handle.table.assemble, _number(t, "t"))


def _choose(
    handle: Handle,
    method: Optional[str],
    step: Optional[float],
    rtol: Optional[float],
    atol: Optional[float],
    form: str,
    stabilisation: Union[str, Tuple[str, float, float]],
    keep_energy: bool,
    most_steps: Optional[int],
) -> None:
    """Sets how the motion is integrated."""
    options = _abi.Options()
    handle.call(handle.table.options, ctypes.byref(options))
    method = method or ("rk4" if step is not None else "dop853")
    options.method = _place("method", _abi.METHODS, method)
    options.form = _place("form", _abi.FORMS, form)
    kind, *gains = [stabilisation] if isinstance(stabilisation, str) else stabilisation
    options.stabilisation = _place("stabilisation", ("projection", "none", "baumgarte"), kind)
    if kind == "baumgarte" and len(gains) != 2:
        raise InvalidValue('write stabilisation=("baumgarte", alpha, beta), gains in 1/s')
    if gains:
        options.alpha, options.beta = (_number(gain, "a gain") for gain in gains)
    options.keep_energy = bool(keep_energy)
    if step is not None:
        if rtol is not None or atol is not None:
            raise InvalidValue("steps are fixed, or follow tolerances: leave out step, or rtol and atol")
        options.step = _number(step, "step")
        if options.step == 0:
            raise InvalidValue("the step must be a positive number of seconds, not 0")
    else:
        options.rtol = _number(1e-9 if rtol is None else rtol, "rtol")
        options.atol = options.rtol if atol is None else _number(atol, "atol")
    if most_steps is not None:
        if int(most_steps) < 1:
            raise InvalidValue(f"most_steps has to be at least 1, not {most_steps}")
        options.most_steps = int(most_steps)
    handle.call(handle.table.set_options, ctypes.byref(options))


def _place(what: str, choices: Sequence[str], choice: str) -> int:
    if choice not in choices:
        raise InvalidValue(f"there is no {what} {choice!r}; there are {', '.join(choices)}")
    return choices.index(choice)
