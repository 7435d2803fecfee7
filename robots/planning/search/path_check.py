"""Looks whether an arm that follows a trajectory would touch anything from an instant on, a few times a second.

The spheres look first, so finely that nothing moves farther than a step of the checker between two looks. As they
hold all of the arm and what it holds, nothing outside that the exact checker would see escapes them. Where they say
blocked the exact checker decides, so that no arm stops for nothing. Two links of one arm they may take
for free although they touch: that depends on the way alone, so the exact checker looks at each way once, and the
ways that it found free are remembered.
"""

from __future__ import annotations

from collections import OrderedDict

import msgspec
import numpy as np

from engine.errors import CellError
from robots.planning.request import PathCheck, PathCheckRequest, SampledTrajectory
from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.scene.exact_checker import CollisionQuery, ExactChecker
from robots.planning.scene.planning_scene import AttachedPart, NamePair, PlanningScene, SceneArm
from robots.planning.search.escape import EscapeChecker
from robots.planning.search.kernels import check_along_path

_KEPT = 16
_Key = tuple[SceneArm, tuple[AttachedPart, ...], tuple[NamePair, ...], bytes]


class SelfCollisionCache:
    """The latest ways along which an arm, as it is with what it holds, does not touch itself."""

    def __init__(self) -> None:
        self._kept: OrderedDict[_Key, float] = OrderedDict()

    def are_free(self, scene: PlanningScene, arm: str, way: SampledTrajectory, from_s: float) -> bool:
        """Return whether that is known of a way from an instant on."""
        return self._kept.get(_key(scene, arm, way), np.inf) <= from_s

    def add(self, scene: PlanningScene, arm: str, way: SampledTrajectory, from_s: float) -> None:
        """Remember a way that was found free from an instant on."""
        key = _key(scene, arm, way)
        self._kept[key] = min(self._kept.pop(key, np.inf), from_s)
        if len(self._kept) > _KEPT:
            self._kept.popitem(last=False)


def _key(scene: PlanningScene, arm: str, way: SampledTrajectory) -> _Key:
    # Where the arm is now does not matter.
    body = msgspec.structs.replace(scene.arm(arm), joints_rad=())
    return body, tuple(part for part in scene.attached if part.arm == arm), scene.allowed, way.position_rad


def check_path(
    request: PathCheckRequest, checker: ExactChecker, problem: CompiledProblem, known: SelfCollisionCache
) -> PathCheck:
    """Return where a way is blocked; an arm nearer to things than the margin at `from_s` may leave, as when planning.

    Raises:
        CellError: the way is not one of this arm.
    """
    if request.way.joints != checker.dof or not request.way.position_rad:
        raise CellError(
            f"a path of {request.way.joints} joints does not fit this arm",
            where=request.arm,
            hint=f"it has {checker.dof}",
        )
    trajectory = request.way.trajectory()
    last = len(trajectory.position_rad) - 1
    first = min(max(int(request.from_s / trajectory.dt_s), 0), last)
    rows = np.ascontiguousarray(trajectory.position_rad[first:])
    looked, blocked = np.empty(len(rows), dtype=np.int64), np.empty(len(rows), dtype=np.bool_)
    own_is_free = known.are_free(request.scene, request.arm, request.way, request.from_s)
    outside = problem._replace(pairs=problem.pairs[:0], pair_gap=problem.pair_gap[:0])
    count = check_along_path(outside, rows, looked, blocked)
    leaving = EscapeChecker(checker, rows[0]) if blocked[0] else None
    looking: CollisionQuery = leaving or checker
    before = -1
    for row, is_blocked in zip(looked[:count].tolist(), blocked[:count].tolist(), strict=True):
        if leaving is not None and not is_blocked:
            leaving.has_left()
        if (
            looking.in_collision(rows[row])
            if is_blocked
            else not own_is_free and checker.touches_known_geometry(rows[row])
        ):
            # What is between this row and the last one looked at may touch before.
            earliest = next(k for k in range(before + 1, row + 1) if k == row or looking.in_collision(rows[k]))
            at_s = min(max((first + earliest) * trajectory.dt_s, request.from_s), last * trajectory.dt_s)
            return PathCheck(blocked_at_s=at_s, pairs=looking.colliding_pairs(rows[earliest]), looked_s=at_s)
        before = row
    if not own_is_free:
        known.add(request.scene, request.arm, request.way, request.from_s)
    return PathCheck(blocked_at_s=None, pairs=(), looked_s=last * trajectory.dt_s)
