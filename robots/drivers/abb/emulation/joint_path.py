"""Joint interpolation through points in given times, corners rounded, the end exact: MoveAbsJ with time and zone."""

from __future__ import annotations

import numpy as np

from robots.port import Array

# The zone z10 in time: its length on the path depends on the tool, which is not known here.
_ZONE_S = 0.05


class InterpolatedPath:
    """Positions over time from where the axes are.

    Args:
        start: Axes at the start.
        targets: Axes of each move.
        moves_s: Time of each move, above 0.
    """

    def __init__(self, start: Array, targets: list[Array], moves_s: list[float]) -> None:
        self._knots = np.vstack((start, *targets))
        self._times = np.concatenate(([0.0], np.cumsum(moves_s)))

    @property
    def duration_s(self) -> float:
        """Time of all moves."""
        return float(self._times[-1])

    def at(self, time_s: float) -> Array:
        """Return the axes at a time."""
        knots, times = self._knots, self._times
        if time_s >= times[-1]:
            return knots[-1]
        move = max(0, int(np.searchsorted(times, time_s, side="right")) - 1)
        rate = self._rate(move)
        position = knots[move] + rate * (time_s - times[move])
        for corner in (move, move + 1):
            if 0 < corner < len(times) - 1:
                before, after = self._rate(corner - 1), self._rate(corner)
                half_s = min(_ZONE_S, *(0.5 * np.diff(times)[corner - 1 : corner + 1]))
                into_s = time_s - times[corner] + half_s
                if 0.0 < into_s < 2.0 * half_s:
                    line = knots[corner] + before * (time_s - times[corner])
                    position = line + (after - before) * into_s**2 / (4.0 * half_s)
        return position

    def _rate(self, move: int) -> Array:
        return (self._knots[move + 1] - self._knots[move]) / (self._times[move + 1] - self._times[move])
