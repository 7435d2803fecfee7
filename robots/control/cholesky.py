"""Small symmetric positive definite systems, solved without the checks that cost more than the work."""

from __future__ import annotations

import numpy as np

from robots.port import Array


def solve_positive_definite(matrix: Array, right: Array) -> Array:
    """Return matrix⁻¹ · right for a symmetric positive definite `matrix`, (n, n), and `right`, (n, m) or (n,).

    Raises:
        ArithmeticError: it is not positive definite.
    """
    from robots.control import kernels

    solution = np.array(right, order="C").reshape(len(right), -1)
    if not kernels.solve_in_place(np.array(matrix, order="C"), solution):
        raise ArithmeticError("a matrix that is inertia is not positive definite")
    return solution.reshape(right.shape)
