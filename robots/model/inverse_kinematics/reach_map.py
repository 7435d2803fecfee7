"""Where the tool of an arm gets: inverse kinematics over a grid, coarse first, without the rest of the cell.

Each point is searched in several directions of the tool's z axis, whose turn about it is free. A search begins at the
configurations of a sample that are nearest to the goal, so it is short where there is no way; a point that is only
reached in a way that no configuration of the sample is near to may be missed.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from engine.cell import ReachDirection, ReachLevel, ReachPoint
from robots.model.inverse_kinematics.chain import jacobian_of
from robots.model.inverse_kinematics.configuration_quality import evaluate_configuration
from robots.model.inverse_kinematics.fast_kinematics import FastKinematics, is_solved, new_fast_kinematics
from robots.model.inverse_kinematics.pose_match import PoseMatch
from robots.model.mechanics.kinematics import ArmKinematics
from robots.port import Array

_SAMPLES, _STARTS = 6000, 4
_LEVELS = (4, 2, 1)
# One turn of the tool's axis weighs as much as this distance when a configuration to begin at is chosen.
_AXIS_M = 0.25
_LEAST_CONDITIONS = 5


def reach_levels(kinematics: ArmKinematics, *, step_m: float, direction: ReachDirection) -> Iterator[ReachLevel]:
    """Yield the reach of an arm at its base, coarse first; deterministic.

    An arm of fewer than five joints cannot choose the direction of its tool: its positions count.

    Args:
        kinematics: The arm at its base.
        step_m: Distance of the points of the finest grid.
        direction: Which directions of the tool count.
    """
    search = _Search(kinematics, direction)
    low, high = search.bounds
    counts = np.floor((high - low) / step_m).astype(int) + 1
    grid = list(itertools.product(*(range(int(count)) for count in counts)))
    found: dict[tuple[int, ...], ReachPoint] = {}
    sizes = [sum(all(index % every == 0 for index in node) for node in grid) for every in _LEVELS]
    for level, every in enumerate(_LEVELS):
        coarser = _LEVELS[level - 1] if level else 0
        for node in grid:
            if any(index % every for index in node) or (coarser and not any(index % coarser for index in node)):
                continue
            point = search.at(low + step_m * np.array(node, dtype=np.float64))
            if point is not None:
                found[node] = point
        yield ReachLevel(
            step_m=every * step_m,
            directions=len(search.axes),
            searched=sizes[level],
            left=sizes[-1] - sizes[level],
            points=tuple(found.values()),
        )


class _Search:
    """Searches single points of the reach of an arm."""

    def __init__(self, kinematics: ArmKinematics, direction: ReachDirection) -> None:
        self._arm: FastKinematics = new_fast_kinematics(kinematics)
        chain = self._arm.chain
        self._match = PoseMatch.AXIS if chain.dof >= _LEAST_CONDITIONS else PoseMatch.POSITION
        self.axes = _directions() if direction == "any" else np.array([[0.0, 0.0, -1.0]])
        if self._match is PoseMatch.POSITION:
            self.axes = self.axes[:1]
        lower, upper = chain.bounds[0], chain.bounds[1]
        self._sample = np.random.default_rng(0).uniform(lower, upper, size=(_SAMPLES, chain.dof))
        tools = np.array([self._arm.lines(joints)[2] for joints in self._sample])
        self._tips, self._tool_axes = tools[:, :, 3], tools[:, :, 2]

    @property
    def bounds(self) -> tuple[Array, Array]:
        """The least and the greatest coordinates of the positions of the sample, in metres."""
        return self._tips.min(axis=0), self._tips.max(axis=0)

    def at(self, xyz: Array) -> ReachPoint | None:
        """Return how a point of the world is reached; None if it is not."""
        away = ((self._tips - xyz) ** 2).sum(axis=1)
        best, reached = 0.0, 0
        for axis in self.axes:
            cost = away
            if self._match is PoseMatch.AXIS:
                cost = away + _AXIS_M**2 * ((self._tool_axes - axis) ** 2).sum(axis=1)
            goal = _goal(xyz, axis)
            for start in np.argpartition(cost, _STARTS)[:_STARTS]:
                attempt = self._arm.descend(goal, self._match, self._sample[start], near=self._sample[start])
                if is_solved(attempt):
                    reached += 1
                    best = max(best, self._manipulability(attempt.joints))
                    break
        if not reached:
            return None
        x, y, z = (round(float(each), 6) for each in xyz)
        return ReachPoint(xyz=(x, y, z), share=reached / len(self.axes), manipulability=best)

    def _manipulability(self, joints: Array) -> float:
        axes, points, tool = self._arm.lines(joints)
        return evaluate_configuration(jacobian_of(self._arm.chain, axes, points, tool), "").manipulability


def _directions() -> Array:
    """Return the twelve corners of an icosahedron, which are even on a sphere, shape (12, 3)."""
    golden = (1.0 + 5.0**0.5) / 2.0
    corners = [
        corner
        for one, other in itertools.product((-1.0, 1.0), (-golden, golden))
        for corner in ((0.0, one, other), (one, other, 0.0), (other, 0.0, one))
    ]
    return np.array(corners) / np.hypot(1.0, golden)


def _goal(xyz: Array, axis: Array) -> Array:
    """Return a pose (3, 4) at a point with this z axis."""
    side = np.array([1.0, 0.0, 0.0]) if abs(axis[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    x = np.cross(side, axis)
    x /= np.linalg.norm(x)
    return np.column_stack((x, np.cross(axis, x), axis, xyz))
