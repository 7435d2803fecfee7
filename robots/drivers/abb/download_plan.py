"""Reduces a sampled trajectory to the points of a download, and measures what the reduction costs."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from robots.port import Array, JointTrajectory

MOST_POINTS = 100
"""The array of the controller's program; it drops further points."""
_FINE_RAD = 5e-4


@dataclass(frozen=True, kw_only=True)
class DownloadPlan:
    """Points to move to one after the other, each in its duration; the first is where the trajectory starts.

    Attributes:
        position_rad: The points, (points, n).
        duration_s: Time of the move to each; that of the first does not matter, as the arm stands there.
        deviation_rad: Largest distance of the given path from the straight lines between the points, each joint.
        lag_rad: Largest distance at the same time, each joint: also what the speed within a line costs.
    """

    position_rad: Array
    duration_s: Array
    deviation_rad: float
    lag_rad: float


def plan_download(trajectory: JointTrajectory, *, speed: float, min_duration_s: float) -> DownloadPlan:
    """Choose at most 100 samples of a trajectory, where straight lines between them deviate most from it.

    Args:
        trajectory: At least one sample.
        speed: Share of its speed, above 0 to 1; durations become longer.
        min_duration_s: Shortest move.
    """
    position = trajectory.position_rad
    last = len(position) - 1
    # With `speed` below 1 moves are longer; the shortest one then has fewer samples.
    stride = max(1, int(np.ceil(min_duration_s * speed / trajectory.dt_s - 1e-9)))
    knots = _chosen(position, last, stride)
    moves_s = np.maximum(np.diff(knots) * trajectory.dt_s / speed, min_duration_s)
    return DownloadPlan(
        position_rad=position[knots],
        duration_s=np.concatenate(([min_duration_s], moves_s)),
        deviation_rad=max((_deviation(position, *line) for line in pairwise(knots)), default=0.0),
        lag_rad=max((_lag(position, *line)[0] for line in pairwise(knots)), default=0.0),
    )


def _chosen(position: Array, last: int, stride: int) -> list[int]:
    """Split the line that lags most, at its worst sample, until all are fine or there are enough points."""
    if last == 0:
        return [0]
    knots = {0, last}
    heap: list[tuple[float, int, int, int]] = []

    def offer(first: int, end: int) -> None:
        if end - first >= 2 * stride:
            lag, worst = _lag(position, first, end)
            heapq.heappush(heap, (-lag, first, end, min(max(worst, first + stride), end - stride)))

    offer(0, last)
    while heap and len(knots) < MOST_POINTS:
        lag, first, end, worst = heapq.heappop(heap)
        if -lag <= _FINE_RAD:
            break
        knots.add(worst)
        offer(first, worst)
        offer(worst, end)
    return sorted(knots)


def _lag(position: Array, first: int, end: int) -> tuple[float, int]:
    """Return the largest distance of any joint from a line at the same time, and its sample."""
    share = (np.arange(first, end + 1) - first)[:, None] / (end - first)
    line = position[first] + share * (position[end] - position[first])
    error = np.abs(position[first : end + 1] - line).max(axis=1)
    worst = int(np.argmax(error))
    return float(error[worst]), first + worst


def _deviation(position: Array, first: int, end: int) -> float:
    """Return the largest distance of any joint from the nearest point of a line."""
    along = position[end] - position[first]
    square = float(along @ along)
    offset = position[first : end + 1] - position[first]
    share = np.clip(offset @ along / square, 0.0, 1.0) if square > 0.0 else np.zeros(len(offset))
    return float(np.abs(offset - share[:, None] * along).max())
