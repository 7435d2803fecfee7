"""Solves small symmetric positive definite systems without checks that cost more than the solution."""

from __future__ import annotations

import numpy as np

from robots.port import Array


def solve_positive_definite(matrix: Array, right: Array) -> Array:
    """Return matrix⁻¹ · right for a symmetric positive definite `matrix`, (n, n), and `right`, (n, m) or (n,).

    Raises:
        ArithmeticError: the matrix is not positive definite.
    """
    from robots.control import kernels

    solution = np.array(right, order="C").reshape(len(right), -1)
    if not kernels.solve_in_place(np.array(matrix, order="C"), solution):
        raise ArithmeticError("the inertia matrix is not positive definite")
    return solution.reshape(right.shape)
