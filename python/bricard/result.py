"""What a run has come to."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _abi
from .errors import UnknownName

if TYPE_CHECKING:
    from .mechanism import Mechanism, State

#: Rows within a step, by which its polynomial is known whatever the method.
_INSIDE = 10


class Event(NamedTuple):
    """An event: its name, when (s), whether its function went up, and the state."""

    name: str
    t: float
    rising: bool
    q: np.ndarray
    v: np.ndarray


class Passage(NamedTuple):
    """A passage through a singular position: when (s), the sine of the weakest constraint,
    and how many are independent there and elsewhere."""

    t: float
    sine: float
    rank: int
    regular: int


class Summary(NamedTuple):
    """What a run did."""

    t: float
    steps: int
    rejected: int
    evaluations: int
    events: int
    passages: int
    undetermined: int
    constraint_error: float
    velocity_error: float
    energy_error: float
    energy_supplied: float
    stopped: bool

    @classmethod
    def of(cls, told: "_abi.Summary", stopped: bool) -> "Summary":
        counts = {name: getattr(told, name) for name in cls._fields[:-1]}
        return cls(**counts, stopped=stopped)

    def __str__(self) -> str:
        return (
            f"t = {self.t:g} s after {self.steps} steps, {self.rejected} rejected, and "
            f"{self.evaluations} accelerations; {self.passages} passages through singular "
            f"positions; largest constraint error {self.constraint_error:.1e}; energy "
            f"balance off by {self.energy_error:.1e} J"
        )


class Result:
    """Rows of a run: ``run["q1"]``, ``run.t``, ``run.q``, ``run.events``, …

    Columns by name: coordinates, velocities ``der(q1)``, states of the first order,
    outputs, reaction forces ``r(q1)``, ``kinetic``, ``potential``, ``energy``,
    ``constraint_error`` and ``velocity_error``.
    """

    def __init__(self, mechanism, recorder, summary, beginning, plan, columns):
        self.mechanism: "Mechanism" = mechanism
        #: Located events, in the order of time.
        self.events: List[Event] = recorder.events
        #: Passages through singular positions, in the order of time.
        self.passages: List[Passage] = recorder.passages
        self.summary: Summary = summary
        self._beginning, self._plan = beginning, plan
        self._rows = recorder.rows()
        self._columns, self._units, self._energies = _named(mechanism, columns)
        self._dense: Optional[Tuple[np.ndarray, np.ndarray]] = None
        self._lock = threading.RLock()

    # ---- columns -------------------------------------------------------------------------

    @property
    def t(self) -> np.ndarray:
        """Times (s)."""
        return self._rows[:, 0]

    @property
    def q(self) -> np.ndarray:
        """Coordinates, a row for each time."""
        return self._rows[:, 1 : 1 + self.mechanism.n]

    @property
    def v(self) -> np.ndarray:
        """Velocities, and states of the first order behind them, a row for each time."""
        first = 1 + self.mechanism.n
        return self._rows[:, first : first + self.mechanism.m]

    @property
    def reactions(self) -> np.ndarray:
        """Generalized reaction forces of the constraints, a row for each time."""
        names = [f"r({quantity.name})" for quantity in self.mechanism.coordinates]
        return np.column_stack([self[name] for name in names])

    def __getitem__(self, name: str) -> np.ndarray:
        if name == "energy" and "energy" not in self._columns and self._energies:
            kinetic, potential = self._energies
            return self._rows[:, kinetic] + self._rows[:, potential]
        try:
            return self._rows[:, self._columns[name]]
        except (KeyError, TypeError):
            known = ", ".join(self.keys())
            raise UnknownName(f"there is no column {name!r}; there are {known}") from None

    def keys(self) -> List[str]:
        """The names of the columns."""
        return list(dict.fromkeys([*self._columns, "energy"]))

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

    def __len__(self) -> int:
        """How many rows there are."""
        return len(self._rows)

    @property
    def units(self) -> Dict[str, str]:
        """The units of the columns, as far as the description gives them."""
        return {**self._units, "energy": self._units.get("energy", "J")}

    @property
    def end(self) -> "State":
        """The state at the last row; ``start=run.end`` goes on from there."""
        from .mechanism import State

        row = len(self) - 1
        return State(float(self.t[row]), self.q[row].copy(), self.v[row].copy())

    # ---- between the rows ----------------------------------------------------------------

    def at(self, t: Union[float, np.ndarray], project: bool = True) -> "State":
        """The state at any time of the run, from the polynomials of its steps.

        For an array of times `q` and `v` have a row for each. States are brought back onto
        the constraints, as they were in the run, unless `project` is false. Asking the first time runs the motion
        again: functions of inputs have to give the same values as before.
        """
        from .mechanism import State

        times = np.asarray(t, dtype=float)
        flat = np.atleast_1d(times)
        with self._lock:
            handle = self._beginning.clone()
            self._points()
        first, last = float(handle.state_if_any()[0]), self.summary.t
        if flat.size and not (flat.min() >= first and flat.max() <= last):
            from .errors import InvalidValue

            raise InvalidValue(f"the run is from t = {first} s to {last} s")
        n = self.mechanism.n
        # The width is told, since no times have none.
        states = np.array([self._inside(x) for x in flat]).reshape(len(flat), n + self.mechanism.m)
        q, v = states[:, :n].copy(), states[:, n:].copy()
        if project and self.mechanism.r:
            for row, x in enumerate(flat):
                handle.project(x, q[row], v[row])
        if times.ndim == 0:
            return State(float(times), q[0], v[0])
        return State(times, q, v)

    def _inside(self, t: float) -> np.ndarray:
        """The state at a time, by the barycentric formula on the points of its step."""
        times, states = self._points()
        if len(times) == 1:
            return states[0]
        steps = (len(times) - 1) // (_INSIDE + 1)
        ends = times[_INSIDE + 1 :: _INSIDE + 1]
        step = min(int(np.searchsorted(ends, t)), steps - 1)
        part = slice(step * (_INSIDE + 1), (step + 1) * (_INSIDE + 1) + 1)
        distance = t - times[part]
        exact = np.flatnonzero(distance == 0)
        if exact.size:
            return states[part][exact[0]]
        weights = (-1.0) ** np.arange(_INSIDE + 2)
        weights[[0, -1]] /= 2
        weights = weights / distance
        return weights @ states[part] / weights.sum()

    def _points(self) -> Tuple[np.ndarray, np.ndarray]:
        """Times and states at the ends of all steps, and within them."""
        if self._dense is None:
            from ._run import run

            plan = self._plan._replace(every=None, until=self.summary.t, on_event=None)
            again = run(self.mechanism, self._beginning.clone(), plan, _INSIDE)
            self._dense = again._rows[:, 0], again._rows[:, 1:]
        return self._dense

    # ---- other forms -----------------------------------------------------------------------

    def to_pandas(self) -> Any:
        """A pandas DataFrame with the times as its index."""
        import pandas

        index = pandas.Index(self.t, name="t")
        return pandas.DataFrame({name: self[name] for name in self.keys() if name != "t"}, index)

    def to_xarray(self) -> Any:
        """An xarray Dataset over time, with units."""
        import xarray

        units = self.units
        columns = {
            name: ("t", self[name], {"units": units[name]} if units[name] else {})
            for name in self.keys()
            if name != "t"
        }
        return xarray.Dataset(columns, {"t": ("t", self.t, {"units": "s"})})

    def plot(self, *names: str, axes: Any = None) -> Any:
        """Plots columns over time by matplotlib, the coordinates if none are named; a line
        for each passage through a singular position. Returns the axes."""
        import matplotlib.pyplot as pyplot

        axes = axes or pyplot.gca()
        wanted = names or tuple(quantity.name for quantity in self.mechanism.coordinates)
        for name in wanted:
            unit = self.units.get(name, "")
            axes.plot(self.t, self[name], label=f"{name} ({unit})" if unit else name)
        for passage in self.passages:
            axes.axvline(passage.t, color="0.8", linewidth=0.8, zorder=0)
        axes.set_xlabel("t (s)")
        axes.legend()
        return axes

    def _repr_html_(self) -> str:
        """The moving picture, for notebooks."""
        from ._picture import html

        return html(self)

    def __repr__(self) -> str:
        return f"<Result of {self.mechanism.name}: {len(self)} rows; {self.summary}>"


def _named(
    mechanism: "Mechanism", bits: int
) -> Tuple[Dict[str, int], Dict[str, str], List[int]]:
    """The places and the units of the columns, by name, and the places of the energies."""
    coordinates = mechanism.coordinates
    force = {"m": "N", "rad": "N*m"}
    listed = [("t", "s")]
    listed += [(x.name, x.unit) for x in coordinates]
    listed += [(f"der({x.name})", f"{x.unit}/s" if x.unit else "") for x in coordinates]
    listed += [(x.name, x.unit) for x in mechanism.states]
    if bits & _abi.WITH_OUTPUTS:
        listed += [(x.name, x.unit) for x in mechanism.outputs]
    if bits & _abi.WITH_REACTIONS:
        listed += [(f"r({x.name})", force.get(x.unit, "")) for x in coordinates]
    energies: List[int] = []
    if bits & _abi.WITH_ENERGIES:
        energies = [len(listed), len(listed) + 1]
        listed += [("kinetic", "J"), ("potential", "J")]
    if bits & _abi.WITH_ERRORS:
        listed += [("constraint_error", ""), ("velocity_error", "")]
    places: Dict[str, int] = {}
    for place, (name, _) in enumerate(listed):
        # A coordinate or an output may have the name of a column; the first keeps it.
        places.setdefault(name, place)
    return places, {name: unit for name, unit in reversed(listed)}, energies
