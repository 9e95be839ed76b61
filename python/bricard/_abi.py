"""The C interface, as ctypes sees it; `bricard.h` is the other half."""

from __future__ import annotations

import ctypes
from ctypes import CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_int, c_int32
from ctypes import c_size_t, c_uint32, c_uint64, c_void_p

ABI = 2

OK, STOPPED, FULL = 0, 1, 2
NULL, LENGTH, INDEX, NAME, NOT_FINITE, ARGUMENT = -1, -2, -3, -4, -5, -6
ORDER, BUSY, ASSEMBLY, RUN, CALLBACK, PANIC = -7, -8, -9, -10, -11, -12

MECHANISM, COORDINATES, PARAMETERS, INPUTS, OUTPUTS, EVENTS, CONSTRAINTS, STATES = range(8)

MASS, FORCE, JACOBIAN, BIAS, RESIDUAL, RATE = range(6)
ACCELERATION, REACTION, OUTPUT, EVENT, ENERGY, RANK = range(6, 12)
SLOPE, OUTPUT_SLOPE, EVENT_SLOPE = range(12, 15)
SAVED = -1

METHODS = ("rk4", "dp5", "dop853", "radau5", "radau9")
FORMS = ("reduced", "full", "multipliers", "partitioning")

WITH_OUTPUTS, WITH_REACTIONS, WITH_ENERGIES, WITH_ERRORS = 1, 2, 4, 8

LINE, CIRCLE, POLYGON, TRACE = range(4)

Handle = c_void_p
Doubles = POINTER(c_double)

Law = CFUNCTYPE(c_int, c_void_p, c_double, Doubles, Doubles, Doubles)
Take = CFUNCTYPE(c_int, c_void_p, Doubles, c_size_t)
OnEvent = CFUNCTYPE(c_int, c_void_p, c_size_t, c_int, c_double, Doubles, Doubles)
OnPassage = CFUNCTYPE(c_int, c_void_p, c_double, c_double, c_size_t, c_size_t)
GoOn = CFUNCTYPE(c_int, c_void_p, c_double, c_uint64)


class Point(Structure):
    _fields_ = [("t", c_double), ("q", Doubles), ("v", Doubles), ("n", c_size_t)]


class Options(Structure):
    _fields_ = [
        ("size", c_size_t),
        ("method", c_int),
        ("form", c_int),
        ("stabilisation", c_int),
        ("keep_energy", c_int),
        ("audit", c_int),
        ("published", c_int),
        ("alpha", c_double),
        ("beta", c_double),
        ("step", c_double),
        ("rtol", c_double),
        ("atol", c_double),
        ("most_steps", c_uint64),
    ]


class Watch(Structure):
    _fields_ = [
        ("size", c_size_t),
        ("user", c_void_p),
        ("every", c_double),
        ("columns", c_uint32),
        ("inside", c_uint32),
        ("rows", Doubles),
        ("room", c_size_t),
        ("take", Take),
        ("event", OnEvent),
        ("passage", OnPassage),
        ("go_on", GoOn),
        ("written", c_size_t),
    ]


class Summary(Structure):
    _fields_ = [
        ("size", c_size_t),
        ("t", c_double),
        ("steps", c_uint64),
        ("rejected", c_uint64),
        ("evaluations", c_uint64),
        ("events", c_uint64),
        ("passages", c_uint64),
        ("undetermined", c_uint64),
        ("constraint_error", c_double),
        ("velocity_error", c_double),
        ("energy_error", c_double),
        ("energy_supplied", c_double),
    ]


def _call(*arguments):
    return CFUNCTYPE(c_int32, *arguments)


_Text = CFUNCTYPE(c_char_p, Handle, c_int, c_size_t)
_Size = POINTER(c_size_t)


class Interface(Structure):
    """The table of functions; calls of them release the interpreter's lock."""

    _fields_ = [
        ("abi", c_uint32),
        ("create", _call(POINTER(Handle))),
        ("clone", _call(Handle, POINTER(Handle))),
        ("assign", _call(Handle, Handle)),
        ("free", CFUNCTYPE(None, POINTER(Handle))),
        ("message", CFUNCTYPE(c_char_p, Handle)),
        ("failed_at", _call(Handle, Doubles)),
        ("count", _call(Handle, c_int, _Size)),
        ("name", _Text),
        ("unit", _Text),
        ("docs", _Text),
        ("find", _call(Handle, c_int, c_char_p, _Size)),
        ("parameter", _call(Handle, c_size_t, Doubles)),
        ("set_parameter", _call(Handle, c_size_t, c_double)),
        ("hold_input", _call(Handle, c_size_t, c_double)),
        ("release_input", _call(Handle, c_size_t)),
        ("drive_input", _call(Handle, c_size_t, Law, c_void_p)),
        ("start", _call(Handle, c_size_t, c_int, Doubles, POINTER(c_int))),
        ("set_start", _call(Handle, c_size_t, c_int, c_double, c_int)),
        ("assemble", _call(Handle, c_double)),
        ("state", _call(Handle, Doubles, Doubles, Doubles, c_size_t)),
        ("set_state", _call(Handle, c_double, Doubles, Doubles, c_size_t)),
        ("options", _call(Handle, POINTER(Options))),
        ("set_options", _call(Handle, POINTER(Options))),
        ("run", _call(Handle, c_double, POINTER(Watch), POINTER(Summary))),
        ("stop", _call(Handle)),
        ("step", _call(Handle, c_double)),
        ("step_once", _call(Handle, c_double)),
        ("size", _call(Handle, c_int, _Size)),
        ("row_size", _call(Handle, c_uint32, _Size)),
        ("evaluate", _call(Handle, c_int, POINTER(Point), Doubles, c_size_t)),
        ("draw", _call(Handle, POINTER(Point), Doubles, c_size_t, _Size)),
        ("project", _call(Handle, c_double, Doubles, Doubles, c_size_t)),
        ("save", _call(Handle, Doubles, c_size_t)),
        ("load", _call(Handle, Doubles, c_size_t)),
    ]


def doubles(array) -> "ctypes._Pointer":
    """A pointer to the numbers of a contiguous array of doubles, which has to outlive it."""
    return array.ctypes.data_as(Doubles)
