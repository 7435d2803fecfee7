"""The compiled search for what of the arms must be visible along some rays of a camera."""

from __future__ import annotations

import math

import numpy as np

from robots.compiled import compiled
from robots.port import Array

_GROUP = 16


@compiled()
def ball_spans(start: Array, along: Array, balls: Array, core: float, beyond: float, front: Array, back: Array) -> None:
    """Write where each ray (k, 3) enters and leaves balls (m, 4) that are larger by `beyond`; infinite and 0 for none.

    `back` is 0 too where the ray passes no ball that is smaller by `core`: there the arm, which the balls cover,
    may be missed.
    """
    groups = (len(balls) + _GROUP - 1) // _GROUP
    around = np.zeros((groups, 4))
    for g in range(groups):
        first, last = g * _GROUP, min((g + 1) * _GROUP, len(balls))
        for b in range(first, last):
            for axis in range(3):
                around[g, axis] += balls[b, axis] / (last - first)
        for b in range(first, last):
            x, y, z = balls[b, 0] - around[g, 0], balls[b, 1] - around[g, 1], balls[b, 2] - around[g, 2]
            around[g, 3] = max(around[g, 3], math.sqrt(x * x + y * y + z * z) + balls[b, 3] + beyond)
    for i in range(len(along)):
        nearest, farthest, hits_core, passes = np.inf, 0.0, False, False
        for b in range(len(balls)):
            if b % _GROUP == 0:
                # Most rays pass most groups of neighbouring balls at a distance.
                g = b // _GROUP
                x, y, z = around[g, 0] - start[0], around[g, 1] - start[1], around[g, 2] - start[2]
                middle = along[i, 0] * x + along[i, 1] * y + along[i, 2] * z
                passes = x * x + y * y + z * z - middle * middle >= around[g, 3] * around[g, 3]
            if passes:
                continue
            x, y, z = balls[b, 0] - start[0], balls[b, 1] - start[1], balls[b, 2] - start[2]
            middle = along[i, 0] * x + along[i, 1] * y + along[i, 2] * z
            if middle <= 0.0:
                continue
            square = x * x + y * y + z * z - middle * middle
            radius = balls[b, 3] + beyond
            if square >= radius * radius:
                continue
            half = math.sqrt(radius * radius - square)
            nearest, farthest = min(nearest, middle - half), max(farthest, middle + half)
            inner = balls[b, 3] - core
            hits_core = hits_core or (inner > 0.0 and square < inner * inner)
        front[i] = nearest
        back[i] = farthest if hits_core else 0.0
