"""A way of straight lines with its corners rounded: smooth enough to be passed without stopping, and close to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.port import Array

_DOUBLE_RAD = 1e-9
_ARC_POINTS, _LINE_POINTS = 21, 13


@dataclass(frozen=True, kw_only=True)
class BlendedPath:
    """A way sampled at `along` (k,), its length so far: positions, first and second derivatives by it, (k, n).

    Near a straight part the derivatives of its points belong to the line; a point where a line meets an
    arc belongs to either, as both are smooth there.
    """

    along: Array
    position: Array
    first: Array
    second: Array

    def pieces(self) -> Array:
        """Return the coefficients of each joint's polynomial between two points, (k - 1, 6, n).

        By the share of the length between the two: quintics that have the positions and derivatives at both points,
        which the lines and the curves of corners are.
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
    """Return the waypoints (k, n) without those that lie where the one before does."""
    kept = [0]
    for i in range(1, len(path)):
        if float(np.linalg.norm(path[i] - path[kept[-1]])) > _DOUBLE_RAD:
            kept.append(i)
    return path[kept]


def blend_corners(path: Array, cuts: Array) -> BlendedPath:
    """Return the way with waypoint i rounded from `cuts[i]` radians before it to as much after it.

    A corner becomes a curve of degree four whose first two derivatives are those of the lines at its ends, so the
    acceleration does not jump. The middle of the curve is 3/16 of a cut times the change of direction off the
    corner. `path` (k, n) has no doubles; `cuts` (k,) is above 0 but at both ends, and half a line at most.
    """
    lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
    directions = np.diff(path, axis=0) / lengths[:, None]
    pieces: list[tuple[Array, Array, Array, Array]] = []
    at = 0.0
    for i, (length, direction) in enumerate(zip(lengths.tolist(), directions, strict=True)):
        begin, end = float(cuts[i]), length - float(cuts[i + 1])
        if end - begin > _DOUBLE_RAD:
            along: Array = np.arange(_LINE_POINTS) * ((end - begin) / (_LINE_POINTS - 1))
            position: Array = path[i] + (begin + along)[:, None] * direction
            pieces.append((at + along, position, np.tile(direction, (len(along), 1)), np.zeros_like(position)))
            at += end - begin
        if i + 2 < len(path):
            arc = _arc(path[i + 1], direction, directions[i + 1], float(cuts[i + 1]))
            pieces.append((at + arc[0], *arc[1:]))
            at += 2.0 * float(cuts[i + 1])
    ways, positions, firsts, seconds = (np.concatenate([piece[k] for piece in pieces]) for k in range(4))
    # Where two pieces meet, one point of the two.
    new = np.append(True, np.diff(ways) > 1e-12)
    return BlendedPath(along=ways[new], position=positions[new], first=firsts[new], second=seconds[new])


def _arc(corner: Array, before: Array, after: Array, cut: float) -> tuple[Array, Array, Array, Array]:
    """Return the curve that leads from a cut before a corner to one after it, by u from 0 to two cuts."""
    u = np.linspace(0.0, 1.0, _ARC_POINTS)[:, None]
    # The direction turns by smoothstep: its derivative is 0 at both ends.
    turn, slope = u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u)
    gone = u**3 - 0.5 * u**4
    change = after - before
    scale = 2.0 * cut
    position = corner - cut * before + scale * (u * before + gone * change)
    return u[:, 0] * scale, position, before + turn * change, slope * change / scale
