"""Runs, and what is recorded of them."""

from __future__ import annotations

import ctypes
import signal
import threading
from typing import TYPE_CHECKING, Any, Callable, List, NamedTuple, Optional

import numpy as np

from . import _abi
from ._handle import Handle
from .errors import InvalidValue, SimulationError
from .result import Event, Passage, Result, Summary

if TYPE_CHECKING:
    from .mechanism import Mechanism

#: Rows at a time, where it is not known how many there will be.
_CHUNK = 1024
#: More rows than this fill a machine's memory.
_MOST_ROWS = 1e9


class Plan(NamedTuple):
    """What is wanted of a run."""

    until: float
    every: Optional[float]
    reactions: bool
    on_event: Optional[Callable[..., Any]]


class _Interrupt:
    """Notices Ctrl-C while the library computes, and does then what would have been done.

    Python handles signals between its own instructions: there are some each time that the
    library asks whether to go on.
    """

    def __init__(self) -> None:
        self.seen: Optional[tuple] = None
        self._before: Any = None
        self._active = threading.current_thread() is threading.main_thread()

    def __enter__(self) -> "_Interrupt":
        if self._active:
            self._before = signal.getsignal(signal.SIGINT)
            self._active = callable(self._before)
        if self._active:
            signal.signal(signal.SIGINT, self._note)
        return self

    def _note(self, number: int, frame: Any) -> None:
        self.seen = (number, frame)

    def __exit__(self, *_: Any) -> None:
        if self._active:
            signal.signal(signal.SIGINT, self._before)
            if self.seen:
                self._before(*self.seen)


class _Recorder:
    """Collects rows, events and passages."""

    def __init__(self, mechanism: "Mechanism", plan: Plan, width: int, room: int):
        self.n, self.m = mechanism.n, mechanism.m
        self.mechanism, self.plan = mechanism, plan
        self.buffer = np.zeros((room, width))
        self.chunks: List[np.ndarray] = []
        self.events: List[Event] = []
        self.passages: List[Passage] = []
        #: What `on_event` has raised.
        self.raised: List[BaseException] = []

    def take(self, _user, _rows, count) -> int:
        self.chunks.append(self.buffer[:count].copy())
        return 0

    def event(self, _user, index, rising, t, q, v) -> int:
        name = self.mechanism.events[index].name
        q, v = np.array(q[: self.n]), np.array(v[: self.m])
        self.events.append(Event(name, t, bool(rising), q, v))
        if self.plan.on_event is None:
            return 0
        try:
            from .mechanism import State

            return int(bool(self.plan.on_event(name, State(t, q, v))))
        except BaseException as error:  # It must not cross the library; `run` raises it.
            self.raised.append(error)
            return 1

    def passage(self, _user, t, sine, rank, regular) -> int:
        self.passages.append(Passage(t, sine, rank, regular))
        return 0

    def rows(self) -> np.ndarray:
        return np.concatenate(self.chunks) if self.chunks else self.buffer[:0].copy()


def _room(handle: Handle, plan: Plan) -> int:
    """How many rows there is to be room for."""
    if plan.every is None:
        return _CHUNK
    t, _, _ = handle.state_if_any()
    rows = (plan.until - t) / plan.every
    if rows > _MOST_ROWS:
        raise InvalidValue(f"a row each {plan.every} s would be {rows:.0e} of them; take fewer")
    return int(min(max(rows, 0.0) + 2, 1 << 16)) if np.isfinite(rows) else 1


def run(mechanism: "Mechanism", handle: Handle, plan: Plan, inside: int = 0) -> Result:
    """Runs a mechanism from where it is."""
    beginning = handle.clone()
    columns = 0
    if not inside:
        columns = _abi.WITH_OUTPUTS | _abi.WITH_ENERGIES | _abi.WITH_ERRORS
        columns |= _abi.WITH_REACTIONS if plan.reactions else 0
    width = handle.number(handle.table.row_size, columns)
    recorder = _Recorder(mechanism, plan, width, _room(handle, plan))
    interrupt = _Interrupt()
    watch = _abi.Watch()
    watch.size = ctypes.sizeof(watch)
    watch.every = plan.every or 0.0
    watch.columns, watch.inside = columns, inside
    watch.rows, watch.room = _abi.doubles(recorder.buffer), recorder.buffer.size
    # The names keep the callbacks alive until the run is over.
    watch.take = take = _abi.Take(recorder.take)
    watch.event = event = _abi.OnEvent(recorder.event)
    watch.passage = passage = _abi.OnPassage(recorder.passage)
    watch.go_on = go_on = _abi.GoOn(lambda _user, _t, _steps: int(bool(interrupt.seen)))
    summary = _abi.Summary()
    with interrupt:
        status = handle.run_status(
            handle.table.run, plan.until, ctypes.byref(watch), ctypes.byref(summary)
        )
    del take, event, passage, go_on
    told = Summary.of(summary, status == _abi.STOPPED)
    result = Result(mechanism, recorder, told, beginning, plan, columns)
    if recorder.raised:
        raise recorder.raised[0]
    if status < 0:
        error = handle.error(status)
        if isinstance(error, SimulationError):
            error.result = result
        raise error
    return result
