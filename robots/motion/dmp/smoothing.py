"""Smooths a recorded motion: a quintic spline with few knots gives clean rates and accelerations."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from engine.errors import RobotError
from robots.port import Array

_DEGREE = 5
# With fewer samples than this between two knots the spline would follow the noise or be underdetermined.
_SAMPLES_PER_KNOT = 3
# A quintic spline at rest at an end has three equal coefficients there.
_EQUAL_AT_REST = 3
FEWEST_SAMPLES = 10
"""Minimum number of samples for learning."""


@dataclass(frozen=True, kw_only=True)
class RestEnds:
    """The ends of a recording at which the arm is at rest."""

    start: bool
    end: bool


@dataclass(frozen=True, kw_only=True)
class SmoothMotion:
    """A smooth motion over the shares 0 to 1 of its duration; `pieces` polynomials."""

    spline: Any
    pieces: int

    def at(self, shares: Array) -> tuple[Array, Array, Array]:
        """Return values, rates per duration and pushes per duration squared at the shares, (T, n) each."""
        values, rates, pushes = (np.asarray(self.spline(shares, order), dtype=np.float64) for order in range(3))
        return values, rates, pushes


def smooth(shares: Array, values: Array, *, intervals: int, rest_ends: RestEnds) -> SmoothMotion:
    """Return the least-squares spline of the samples with at most `intervals` pieces.

    Args:
        shares: Sample times, increasing from 0 to 1, (T,).
        values: The samples, (T, n).
        intervals: Maximum number of pieces.
        rest_ends: Where rate and acceleration are 0.

    Raises:
        RobotError: there are too few samples.
    """
    if len(shares) < FEWEST_SAMPLES:
        raise RobotError(
            f"the recording has {len(shares)} samples of the motion", hint=f"record at least {FEWEST_SAMPLES} of them"
        )
    # scipy has no type stubs and takes most of a second to import: it is imported here only.
    splines: Any = import_module("scipy.interpolate")
    pieces = max(1, min(intervals, (len(shares) - _DEGREE - 1) // _SAMPLES_PER_KNOT))
    # Inner knots lie at quantiles of the samples, so that a gap in the recording takes no knots.
    inner = np.interp(np.linspace(0.0, 1.0, pieces + 1)[1:-1], np.linspace(0.0, 1.0, len(shares)), shares)
    knots = np.concatenate((np.zeros(_DEGREE + 1), inner, np.ones(_DEGREE + 1)))
    design = splines.BSpline.design_matrix(shares, knots, _DEGREE)
    ties = _ties(pieces + _DEGREE, rest_ends)
    normal: Array = np.asarray(ties.T @ (design.T @ design) @ ties, dtype=np.float64)
    right: Array = np.asarray(ties.T @ (design.T @ values), dtype=np.float64)
    free = np.linalg.solve(normal + 1e-12 * len(shares) / pieces * np.eye(len(normal)), right)
    return SmoothMotion(spline=splines.BSpline(knots, ties @ free, _DEGREE), pieces=pieces)


def _ties(coefficients: int, rest_ends: RestEnds) -> Array:
    """Return the matrix from free to spline coefficients: at rest those at the end coincide."""
    kept = list(range(coefficients))
    if rest_ends.start and len(kept) > _EQUAL_AT_REST:
        kept[:_EQUAL_AT_REST] = [0] * _EQUAL_AT_REST
    if rest_ends.end and coefficients > 2 * _EQUAL_AT_REST - 1:
        kept[-_EQUAL_AT_REST:] = [coefficients - _EQUAL_AT_REST] * _EQUAL_AT_REST
    used = sorted(set(kept))
    ties = np.zeros((coefficients, len(used)))
    ties[np.arange(coefficients), np.searchsorted(used, kept)] = 1.0
    return ties
