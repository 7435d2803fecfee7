"""Lower bounds of many distances at once, compiled: what moved since the last look could have come nearer by as much.

Shapes and units: distances in m; `n` geometries, `m` pairs of them in `g` groups of consecutive rows.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from robots.compiled import compiled
from robots.port import Array

Indices = NDArray[np.int64]


@compiled(
    "float64(float64[:,::1], float64[:,::1], float64[:,::1], float64[:,::1], float64[::1], int64[::1], int64[::1],"
    " int64[::1], float64[::1], float64[::1], float64[::1])"
)
def take_moved(
    xyz: Array,
    rotations: Array,
    last_xyz: Array,
    last_rotations: Array,
    radii: Array,
    first: Indices,
    second: Indices,
    starts: Indices,
    moved: Array,
    bounds: Array,
    nearest: Array,
) -> float:
    """Take from each bound what its two geometries have moved, and return the largest movement of a geometry.

    Args:
        xyz: Centres, (n, 3).
        rotations: Their rotation matrices, row by row, (n, 9).
        last_xyz: Those of the last look, which become the present ones.
        last_rotations: Those of the last look, too.
        radii: Radii of the spheres around them, (n,).
        first: The first geometry of each pair, (m,).
        second: The second one.
        starts: The first row of each group, (g,).
        moved: Space for the movements, (n,).
        bounds: The bounds, (m,), changed in place.
        nearest: Where the least bound of each group is written, (g,).
    """
    largest = 0.0
    for i in range(len(radii)):
        shift = 0.0
        for k in range(3):
            change = xyz[i, k] - last_xyz[i, k]
            shift += change * change
            last_xyz[i, k] = xyz[i, k]
        turn = 0.0
        for k in range(9):
            change = rotations[i, k] - last_rotations[i, k]
            turn += change * change
            last_rotations[i, k] = rotations[i, k]
        # The Frobenius norm of the difference of two rotations is the square root of two times its largest gain.
        moved[i] = math.sqrt(shift) + radii[i] * math.sqrt(0.5 * turn)
        largest = max(largest, moved[i])
    for group in range(len(starts)):
        end = starts[group + 1] if group + 1 < len(starts) else len(bounds)
        least = math.inf
        for row in range(starts[group], end):
            bounds[row] -= moved[first[row]] + moved[second[row]]
            least = min(least, bounds[row])
        nearest[group] = least
    return largest


@compiled("int64(float64[::1], int64, int64)")
def least_row(bounds: Array, start: int, end: int) -> int:
    """Return the row from `start` to before `end` with the least bound."""
    row = start
    for other in range(start + 1, end):
        if bounds[other] < bounds[row]:
            row = other
    return row
