"""Blends the corners of a path of straight lines, so that the arm follows it closely without stopping."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.port import Array

_DUPLICATE_RAD = 1e-9
_ARC_POINTS, _LINE_POINTS = 21, 13
MIDDLE_SHARE = 0.1875
"""Distance of the middle of a blend from its corner, as a share of the cut times the change of direction."""


@dataclass(frozen=True, kw_only=True)
class BlendedPath:
    """A path sampled at arc lengths `along` (k,): positions and their first and second derivatives, (k, n).

    On a straight part the derivatives are those of the line; at a point where a line meets a
    curve both agree.
    """

    along: Array
    position: Array
    first: Array
    second: Array

    def pieces(self) -> Array:
        """Return the coefficients of each joint's polynomial between two points, (k - 1, 6, n).

        The variable is the share of the length between the two points. The quintics match the positions and
        derivatives at both points and so equal the lines and corner curves.
        """
        h = np.diff(self.along)[:, None]
        d0, d1 = h * self.first[:-1], h * self.first[1:]
        b0, b1 = h**2 * self.second[:-1], h**2 * self.second[1:]
        rise = self.position[1:] - self.position[:-1] - d0 - 0.5 * b0
        turn, bend = d1 - d0 - b0, b1 - b0
        third, fourth = 10.0 * rise - 4.0 * turn + 0.5 * bend, -15.0 * rise + 7.0 * turn - bend
        fifth = 6.0 * rise - 3.0 * turn + 0.5 * bend
        return np.stack((self.position[:-1], d0, 0.5 * b0, third, fourth, fifth), axis=1)


def remove_duplicates(path: Array) -> Array:
    """Return the waypoints (k, n) without those that equal their predecessor."""
    kept = [0]
    for i in range(1, len(path)):
        if float(np.linalg.norm(path[i] - path[kept[-1]])) > _DUPLICATE_RAD:
            kept.append(i)
    return path[kept]


def blend_corners(path: Array, cuts: Array) -> BlendedPath:
    """Return the path with waypoint i blended from `cuts[i]` radians before it to the same length after it.

    A corner becomes a curve of degree four whose first two derivatives equal those of the lines at its ends, so the
    acceleration is continuous. The middle of the curve deviates from the corner by 3/16 of a cut times the change
    of direction. `path` (k, n) has no duplicates; `cuts` (k,) is positive except at both ends, and at most half a
    line.
    """
    lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
    directions = np.diff(path, axis=0) / lengths[:, None]
    pieces: list[tuple[Array, Array, Array, Array]] = []
    at = 0.0
    for i, (length, direction) in enumerate(zip(lengths.tolist(), directions, strict=True)):
        begin, end = float(cuts[i]), length - float(cuts[i + 1])
        if end - begin > _DUPLICATE_RAD:
            along: Array = np.arange(_LINE_POINTS) * ((end - begin) / (_LINE_POINTS - 1))
            position: Array = path[i] + (begin + along)[:, None] * direction
            pieces.append((at + along, position, np.tile(direction, (len(along), 1)), np.zeros_like(position)))
            at += end - begin
        if i + 2 < len(path):
            arc = _arc(path[i + 1], direction, directions[i + 1], float(cuts[i + 1]))
            pieces.append((at + arc[0], *arc[1:]))
            at += 2.0 * float(cuts[i + 1])
    lengths_along, positions, firsts, seconds = (np.concatenate([piece[k] for piece in pieces]) for k in range(4))
    # Keep one of the two points where pieces meet.
    new = np.append(True, np.diff(lengths_along) > 1e-12)
    return BlendedPath(along=lengths_along[new], position=positions[new], first=firsts[new], second=seconds[new])


def _arc(corner: Array, before: Array, after: Array, cut: float) -> tuple[Array, Array, Array, Array]:
    """Return the curve from a cut before a corner to a cut after it, by its length from 0 to two cuts."""
    u = np.linspace(0.0, 1.0, _ARC_POINTS)[:, None]
    # The direction changes by smoothstep, whose derivative is 0 at both ends.
    turn, slope = u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u)
    progress = u**3 - 0.5 * u**4
    change = after - before
    scale = 2.0 * cut
    position = corner - cut * before + scale * (u * before + progress * change)
    return u[:, 0] * scale, position, before + turn * change, slope * change / scale
