"""The mechanisms of the library, by name: ``bricard.library.double_four_bar``."""

from __future__ import annotations

from typing import List

from . import _compile
from .errors import UnknownName
from .mechanism import Mechanism


def __getattr__(name: str) -> Mechanism:
    if name.startswith("_"):
        raise AttributeError(name)
    try:
        return Mechanism(_compile.compiled(name), _is_library=True)
    except UnknownName as error:
        raise AttributeError(str(error)) from None


def __dir__() -> List[str]:
    return _compile.names()
