"""Sets of solutions: duplicates removed, whole turns added within limits, ordered by time from the seed."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from robots.model.inverse_kinematics.chain import KinematicChain
from robots.port import Array

_SAME_RAD = 1e-4
_TURN = 2.0 * math.pi


@dataclass(frozen=True, kw_only=True)
class SolutionSet:
    """The solutions for a goal, soonest reached first.

    `joints` (k, n) are within the limits, k is at least 1. `complete` is true if these are all solutions;
    a redundant arm has infinitely many, and then `joints` is a sample. `how` names the method.
    """

    joints: Array
    complete: bool
    how: str


def distinct(chain: KinematicChain, joints: Array) -> Array:
    """Return the distinct rows of (k, n), up to whole turns."""
    kept = np.empty((0, chain.dof))
    turning = ~chain.sliding
    for row in joints:
        away = kept - row
        away[:, turning] -= _TURN * np.round(away[:, turning] / _TURN)
        if not (np.abs(away).max(axis=1, initial=0.0) < _SAME_RAD).any():
            kept = np.vstack((kept, row))
    return kept


def with_turns(chain: KinematicChain, joints: Array) -> Array:
    """Return the rows of (k, n) with every joint in every turn within its limits."""
    rows: list[tuple[float, ...]] = []
    for row in joints:
        choices = [_turns(chain, i, float(value)) for i, value in enumerate(row)]
        rows.extend(itertools.product(*choices))
    return np.array(rows).reshape(-1, chain.dof)


def soonest_first(chain: KinematicChain, joints: Array, seed: Array) -> Array:
    """Return the rows of (k, n) ordered by the time of the slowest joint from `seed`."""
    times = np.abs((joints - seed) / chain.bounds[2]).max(axis=1, initial=0.0)
    return joints[np.argsort(times, kind="stable")]


def _turns(chain: KinematicChain, i: int, value: float) -> list[float]:
    if chain.sliding[i]:
        return [value]
    lower, upper = float(chain.bounds[0, i]), float(chain.bounds[1, i])
    first, last = math.ceil((lower - 1e-8 - value) / _TURN), math.floor((upper + 1e-8 - value) / _TURN)
    return [min(max(value + k * _TURN, lower), upper) for k in range(first, last + 1)]
