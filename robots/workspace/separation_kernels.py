"""The compiled search for the point that is nearest to the balls of an arm."""

from __future__ import annotations

import math

from robots.compiled import compiled
from robots.port import Array


@compiled("Tuple((f8, i8, i8))(f8[:, ::1], f8[:, ::1], f8)")
def nearest_point(points: Array, balls: Array, within: float) -> tuple[float, int, int]:
    """Return the least distance of points (k, 3) from the surfaces of balls (m, 4), below 0 inside, and both numbers.

    Distances from `within` on do not count; without a shorter one the numbers are -1.
    """
    least, point, ball = within, -1, -1
    for j in range(len(balls)):
        x, y, z, radius = balls[j, 0], balls[j, 1], balls[j, 2], balls[j, 3]
        reach = least + radius
        if reach <= 0.0:
            continue
        square = reach * reach
        for i in range(len(points)):
            a, b, c = points[i, 0] - x, points[i, 1] - y, points[i, 2] - z
            apart = a * a + b * b + c * c
            if apart < square:
                square = apart
                least, point, ball = math.sqrt(apart) - radius, i, j
    return least, point, ball
