"""The compiled search for what of the arms must be visible along some rays of a camera."""

from __future__ import annotations

import math

import numpy as np

from robots.compiled import compiled
from robots.port import Array

_NEAREST_M = 0.01
_BESIDE = 1e-9


@compiled()
def _passing(beside: float, ahead: float, radius: float, places: Array) -> tuple[int, int]:
    """Return the first and last + 1 of the increasing `places` at which rays may pass a ball; all near the camera."""
    near, far = ahead - radius, ahead + radius
    if near < _NEAREST_M:
        return 0, len(places)
    low = min((beside - radius) / near, (beside - radius) / far) - _BESIDE
    high = max((beside + radius) / near, (beside + radius) / far) + _BESIDE
    first = 0
    while first < len(places) and places[first] < low:
        first += 1
    last = first
    while last < len(places) and places[last] <= high:
        last += 1
    return first, last


@compiled()
def ball_spans(
    start: Array,
    turn: Array,
    across: Array,
    down: Array,
    along: Array,
    balls: Array,
    core: float,
    beyond: float,
    front: Array,
    back: Array,
) -> None:
    """Write where each ray enters and leaves balls (m, 4) that are larger by `beyond`; infinite and 0 for none.

    The rays are a grid, row by row: `across` and `down`, both increasing, are where they pass the plane 1 m ahead of
    the camera, which is at `start` with the axes `turn` (3, 3); `along` (k, 3) are their directions in the world.
    `back` is 0 too where the ray passes no ball that is smaller by `core`: there the arm, which the balls cover,
    may be missed.
    """
    columns, rows = len(across), len(down)
    hits_core = np.zeros(len(along), dtype=np.bool_)
    front[:] = np.inf
    back[:] = 0.0
    for b in range(len(balls)):
        x, y, z = balls[b, 0] - start[0], balls[b, 1] - start[1], balls[b, 2] - start[2]
        radius, inner = balls[b, 3] + beyond, balls[b, 3] - core
        ahead = turn[0, 2] * x + turn[1, 2] * y + turn[2, 2] * z
        if ahead + radius <= 0.0:
            continue
        left, right = _passing(turn[0, 0] * x + turn[1, 0] * y + turn[2, 0] * z, ahead, radius, across)
        top, bottom = _passing(turn[0, 1] * x + turn[1, 1] * y + turn[2, 1] * z, ahead, radius, down)
        for row in range(top, bottom):
            for i in range(row * columns + left, row * columns + right):
                middle = along[i, 0] * x + along[i, 1] * y + along[i, 2] * z
                if middle <= 0.0:
                    continue
                square = x * x + y * y + z * z - middle * middle
                if square >= radius * radius:
                    continue
                half = math.sqrt(radius * radius - square)
                front[i], back[i] = min(front[i], middle - half), max(back[i], middle + half)
                hits_core[i] = hits_core[i] or (inner > 0.0 and square < inner * inner)
    for i in range(rows * columns):
        if not hits_core[i]:
            back[i] = 0.0
