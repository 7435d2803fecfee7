"""Linear least squares with the standard deviations of the solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.port import Array


@dataclass(frozen=True, kw_only=True)
class Fit:
    """The solution (m,), its standard deviations (m,), and what it leaves of the measurements, (k,)."""

    solution: Array
    deviation: Array
    residual: Array


def fit(matrix: Array, measured: Array, *, independent: float, least_share: float = 0.0) -> Fit | None:
    """Return the solution of `matrix` (k, m) x = `measured` (k,).

    Args:
        matrix: The regressors.
        measured: The measurements.
        independent: Number of independent measurements. Residuals of neighbouring samples of a motion have one cause, a
            sliding part or an error of the model, so that more samples make the solution no better.
        least_share: Smallest singular value of the scaled matrix as a share of the largest; None is returned below.
    """
    scale = np.linalg.norm(matrix, axis=0)
    if not (scale > 0.0).all():
        return None
    rows, singular, axes = np.linalg.svd(matrix / scale, full_matrices=False)
    if singular[-1] <= least_share * singular[0]:
        return None
    solution: Array = ((rows.T @ measured) / singular) @ axes / scale
    residual: Array = measured - matrix @ solution
    variance = float(np.mean(residual**2)) * len(residual) / independent
    deviation: Array = np.sqrt(variance * ((axes / singular[:, None]) ** 2).sum(axis=0)) / scale
    return Fit(solution=solution, deviation=deviation, residual=residual)
