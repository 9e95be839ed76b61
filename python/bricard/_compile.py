"""Compiles descriptions by the ``bricard`` command, which keeps what it has compiled."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from pathlib import Path
from typing import List

from . import _abi
from .errors import CompileError, DescriptionError, UnknownName

_MISSING = (
    "the command `bricard` was not found, and it compiles descriptions: install it with "
    "`cargo install --path .` in a checkout of bricard, or name it in the variable BRICARD; "
    "libraries that `bricard export --to c` has written need neither "
    "(`Mechanism.from_library`)"
)


def _command() -> str:
    """The command, as the variable BRICARD or the PATH names it."""
    named = os.environ.get("BRICARD")
    found = shutil.which(named if named else "bricard")
    if found is None:
        raise CompileError(_MISSING)
    return found


def _said(arguments: List[str]) -> str:
    """What the command prints; its errors as exceptions."""
    try:
        done = subprocess.run(
            [_command(), *arguments], capture_output=True, encoding="utf-8", check=False
        )
    except OSError as error:
        raise CompileError(f"the command `bricard` could not be started: {error}") from error
    if done.returncode == 0:
        return done.stdout
    said = done.stderr.strip()
    message = said.rsplit("error: ", 1)[-1] if said.count("error: ") == 1 else said
    if "the description is wrong" in said:
        raise DescriptionError(said[said.index("error: ") + len("error: ") :])
    if "there is no mechanism" in said:
        raise UnknownName(message)
    raise CompileError(message or f"`bricard` ended with status {done.returncode}")


def compiled(subject: str) -> Path:
    """The shared library of a description's file, or of a mechanism of the library."""
    return Path(_said(["export", subject, "--to", "library"]).strip())


def names() -> List[str]:
    """The names of the library's mechanisms."""
    table = _said(["list"]).split("benchmark problems")[0]
    rows = [line.split() for line in table.splitlines()]
    # Behind a name there is how many coordinates it has.
    return [row[0] for row in rows if len(row) > 2 and row[1].isdigit()]


def interface(path: Path) -> "_abi.Interface":
    """The table of functions of a shared library."""
    try:
        library = ctypes.CDLL(os.fspath(path.resolve()))
    except OSError as error:
        raise CompileError(f"{path} could not be loaded: {error}") from error
    stem = path.name.split(".")[0]
    module = stem[stem.find("bricard_") + len("bricard_") :]
    try:
        function = library[f"{module}_interface"]
    except AttributeError:
        raise CompileError(f"{path} is no library of a mechanism by its name") from None
    function.argtypes = [ctypes.c_uint32]
    function.restype = ctypes.POINTER(_abi.Interface)
    table = function(_abi.ABI)
    if not table:
        raise CompileError(
            f"{path} is of another version of the C interface than this package "
            f"({_abi.ABI}); compile it anew"
        )
    # The table lives as long as the library, which nobody unloads.
    return table.contents
