"""Compiled functions do what the plain ones do, whether or not there is a place for the cache."""

from __future__ import annotations

from types import FunctionType

import numpy as np
import pytest

from robots.compiled import compiled
from robots.port import Array


def double(value: float) -> float:
    return 2.0 * value


@pytest.mark.parametrize("signatures", [(), ("f8(f8)",)])
def test_a_function_without_a_place_for_its_cache_is_compiled_all_the_same(signatures: tuple[str, ...]) -> None:
    """As on a machine on which nothing can be written."""
    homeless = FunctionType(double.__code__.replace(co_filename="<nowhere>"), {"__name__": __name__})
    quick = compiled(*signatures)(homeless)
    assert quick(3.0) == 6.0
    assert type(quick).__name__ == "CPUDispatcher"


def test_another_failure_to_compile_is_not_hidden() -> None:
    """Such as a signature of two numbers for a function of one."""
    with pytest.raises(TypeError, match="Signature mismatch"):
        compiled("f8(f8, f8)")(double)


def test_linear_algebra_is_compiled_as_ever() -> None:
    """numba asks for scipy's when a function is compiled that needs it."""

    def solved(matrix: Array, right: Array) -> float:
        return float(np.linalg.det(matrix) + np.dot(right, right))

    homeless = FunctionType(solved.__code__.replace(co_filename="<nowhere>"), {"np": np, "float": float})
    assert compiled()(homeless)(np.diag([2.0, 4.0]), np.array([8.0, 0.0])) == 8.0 + 64.0
