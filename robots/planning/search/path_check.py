"""Checks whether an arm that follows a trajectory collides from a given time on, a few times a second.

The spheres are checked first, in steps in which no point moves farther than the checker's step. As they
contain the arm and its parts, they miss no external collision that the exact checker would find. Where they are
blocked the exact checker decides, so that no arm stops without cause. They may miss self-collisions between two
links: these depend on the trajectory alone, so the exact checker checks each trajectory once, and
trajectories that it found free are cached.
"""

from __future__ import annotations

from collections import OrderedDict

import msgspec
import numpy as np

from engine.errors import CellError
from robots.planning.request import PathCheck, PathCheckRequest
from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.scene.exact_checker import CollisionQuery, ExactChecker
from robots.planning.scene.planning_scene import AttachedPart, NamePair, PlanningScene, SceneArm
from robots.planning.search.escape import EscapeChecker
from robots.planning.search.kernels import check_along_path
from robots.port import JointTrajectory

_CACHE_SIZE = 16
_Key = tuple[SceneArm, tuple[AttachedPart, ...], tuple[NamePair, ...], bytes]


class SelfCollisionCache:
    """Caches the latest trajectories without self-collision of an arm and its attached parts."""

    def __init__(self) -> None:
        self._free_from_s: OrderedDict[_Key, float] = OrderedDict()

    def are_free(self, scene: PlanningScene, arm: str, trajectory: JointTrajectory, from_s: float) -> bool:
        """Return whether a trajectory is known to be free from a time on."""
        return self._free_from_s.get(_key(scene, arm, trajectory), np.inf) <= from_s

    def add(self, scene: PlanningScene, arm: str, trajectory: JointTrajectory, from_s: float) -> None:
        """Record a trajectory that is free from a time on."""
        key = _key(scene, arm, trajectory)
        self._free_from_s[key] = min(self._free_from_s.pop(key, np.inf), from_s)
        if len(self._free_from_s) > _CACHE_SIZE:
            self._free_from_s.popitem(last=False)


def _key(scene: PlanningScene, arm: str, trajectory: JointTrajectory) -> _Key:
    # The current joints of the arm do not matter.
    body = msgspec.structs.replace(scene.arm(arm), joints_rad=())
    return (
        body,
        tuple(part for part in scene.attached if part.arm == arm),
        scene.allowed,
        trajectory.position_rad.tobytes(),
    )


def require_fit(trajectory: JointTrajectory, *, arm: str, dof: int) -> None:
    """Raise CellError unless a trajectory has samples of `dof` joints."""
    rows = trajectory.position_rad
    if rows.ndim != 2 or rows.shape[1] != dof or not len(rows):
        raise CellError(f"a path of {rows.shape[-1]} joints does not fit this arm", where=arm, hint=f"it has {dof}")


def check_path(
    request: PathCheckRequest, checker: ExactChecker, problem: CompiledProblem, known: SelfCollisionCache
) -> PathCheck:
    """Return where a trajectory is blocked; an arm within the margin at `from_s` may leave it, as in planning.

    Raises:
        CellError: the trajectory does not fit this arm.
    """
    trajectory = request.trajectory
    require_fit(trajectory, arm=request.arm, dof=checker.dof)
    last = len(trajectory.position_rad) - 1
    first = min(max(int(request.from_s / trajectory.dt_s), 0), last)
    rows = np.ascontiguousarray(trajectory.position_rad[first:])
    checked, blocked = np.empty(len(rows), dtype=np.int64), np.empty(len(rows), dtype=np.bool_)
    own_is_free = known.are_free(request.scene, request.arm, trajectory, request.from_s)
    outside = problem._replace(pairs=problem.pairs[:0], pair_gap=problem.pair_gap[:0])
    count = check_along_path(outside, rows, checked, blocked)
    escape = EscapeChecker(checker, rows[0]) if blocked[0] else None
    query: CollisionQuery = escape or checker
    before = -1
    for row, is_blocked in zip(checked[:count].tolist(), blocked[:count].tolist(), strict=True):
        if escape is not None and not is_blocked:
            escape.has_left()
        if (
            query.in_collision(rows[row])
            if is_blocked
            else not own_is_free and checker.touches_known_geometry(rows[row])
        ):
            # A row between the last checked one and this one may collide earlier.
            earliest = next(k for k in range(before + 1, row + 1) if k == row or query.in_collision(rows[k]))
            at_s = min(max((first + earliest) * trajectory.dt_s, request.from_s), last * trajectory.dt_s)
            return PathCheck(blocked_at_s=at_s, pairs=query.colliding_pairs(rows[earliest]), looked_s=at_s)
        before = row
    if not own_is_free:
        known.add(request.scene, request.arm, trajectory, request.from_s)
    return PathCheck(blocked_at_s=None, pairs=(), looked_s=last * trajectory.dt_s)
