"""Compiles numeric functions to machine code on first import, kept in a cache where one can be written.

Import a module of compiled functions only where it is used: numba takes a third of a second.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

_F = TypeVar("_F", bound=Callable[..., Any])

# numba ships no usable types for its decorators; the decorator below gives back the plain function's type.
_numba: Any = import_module("numba")


def compiled(*signatures: str) -> Callable[[_F], _F]:
    """Return a decorator that compiles a function, which then runs without holding the interpreter lock.

    With `signatures` (numba's notation) it is compiled when its module is imported, so that no call is
    slow; without, when another compiled function first needs it. Arithmetic keeps the order that is
    written down, so that results repeat. Functions that call one another belong in one file: the cache
    notices changes of a function's own file only.
    """

    def decorate(function: _F) -> _F:
        wanted = list(signatures) or None
        try:
            return _numba.njit(wanted, nogil=True, cache=True)(function)
        except RuntimeError as error:
            # Neither the folder of the source nor the user's cache folder can be written.
            if "no locator available" not in str(error):
                raise
            return _numba.njit(wanted, nogil=True)(function)

    return decorate
