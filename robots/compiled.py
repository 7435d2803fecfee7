"""Compiles numeric functions to machine code on first import and caches the result where a cache is writable.

Import a module of compiled functions only where it is used: importing numba takes a third of a second.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

_F = TypeVar("_F", bound=Callable[..., Any])


def _load_numba() -> Any:
    """Return numba, loaded without scipy's linear algebra, which is a third of the load time of a compiled function.

    numba loads it before the first function, to check whether `np.correlate` and `np.convolve` may use BLAS.
    Functions with `@`, `np.dot` or `np.linalg` load it when they are compiled.
    """
    numba: Any = import_module("numba")
    algebra: Any = import_module("numba.np.linalg")
    if not hasattr(algebra, "ensure_blas"):
        return numba
    with import_module("numba.core.compiler_lock").global_compiler_lock:
        ensure_blas = algebra.ensure_blas
        algebra.ensure_blas = _refuse_blas
        try:
            arrays: Any = import_module("numba.np.arraymath")
            arrays.ensure_blas = ensure_blas
        finally:
            algebra.ensure_blas = ensure_blas
    return numba


def _refuse_blas() -> None:
    raise ImportError("not needed yet")


# numba ships no usable types for its decorators; the decorator below returns the plain function's type.
_numba: Any = _load_numba()


def compiled(*signatures: str) -> Callable[[_F], _F]:
    """Return a decorator that compiles a function, which then runs without the global interpreter lock.

    With `signatures` (in the syntax of numba) the function is compiled when its module is imported, so that no
    call is slow; without, when another compiled function first needs it. Arithmetic keeps the order of the
    source, so that results are reproducible. Functions that call one another belong in one file: the cache
    detects changes of a function's own file only.
    """

    def decorate(function: _F) -> _F:
        eager = list(signatures) or None
        try:
            return _numba.njit(eager, nogil=True, cache=True)(function)
        except RuntimeError as error:
            # Neither the folder of the source nor the user's cache folder can be written.
            if "no locator available" not in str(error):
                raise
            return _numba.njit(eager, nogil=True)(function)

    return decorate
