"""Looks whether what an arm holds would touch anything on a way that was planned without looking.

A held part may touch

- what the scene allows it to;
- what it touches when the way begins, as the table that it is lifted from: no deeper than then, until they have parted;
- what it is put down on, which is an obstacle or a part that nobody holds: at the end of the way, where no point of it
  is farther than `CONTACT_M` from its last place, and no deeper than that.

All else is a collision: contact that comes before the end of the way, and contact with arms and with what they hold.
The arm itself is not looked at.
"""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import numpy as np

from engine.errors import CellError
from engine.skills.planning_scene import CONTACT_M
from robots.model.robot_model import RobotModel
from robots.planning.request import AttachedPartCheckRequest, PathCheck
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.pair_checks import TOUCHING_M, PairChecks
from robots.planning.scene.planning_scene import NamePair, PlanningScene
from robots.planning.scene.static_scene import arm_in_scene
from robots.port import Array
from robots.sim.scene.sim_scene import ArmPlacement

_STEP_M, _FINE_M = 0.005, 0.0005
"""No point of what is held moves farther between two looks; so exactly is known where the end of a way begins."""
_SLACK_M, _EXACT_M = 0.001, 1e-4
"""What touches at the start may come so much deeper before it has parted, and has when it is so far apart; distances of
shapes that are in one another are right to about the second."""


def check_attached_parts(
    request: AttachedPartCheckRequest, *, robot: Callable[[ArmPlacement], RobotModel]
) -> PathCheck:
    """Return where on a way what the arm holds would touch something that it must not; `robot` loads models.

    Raises:
        CellError: the scene has no such arm, something in it is wrong, or the way is not this arm's.
    """
    scene = _held_alone(request.scene, request.arm)
    checker = ExactChecker(scene, request.arm, among=arm_in_scene(scene, request.arm, robot=robot))
    if request.way.joints != checker.dof or not request.way.position_rad:
        raise CellError(
            f"a path of {request.way.joints} joints does not fit this arm",
            where=request.arm,
            hint=f"it has {checker.dof}",
        )
    trajectory = request.way.trajectory()
    rows = trajectory.position_rad
    checks = checker.checks[0]
    moved_m = _moved(checker, rows)
    ending = _ending(checker, rows, moved_m)
    contacts = _Contacts(checks, supports=frozenset(one.name for one in scene.obstacles), start=rows[0])
    # The one before the end begins tells whether a contact comes before it.
    for row in sorted({*_rows_every(_STEP_M, moved_m), max(0, ending - 1), len(rows) - 1}):
        touching = contacts.refused(rows[row], at_end=row >= ending)
        if touching:
            at_s = row * trajectory.dt_s
            return PathCheck(blocked_at_s=at_s, pairs=touching, looked_s=at_s)
    return PathCheck(blocked_at_s=None, pairs=(), looked_s=trajectory.duration_s)


class _Contacts:
    """What touches, configuration after configuration along a way, that must not.

    Args:
        checks: The pairs of which one is held.
        supports: The names of what it may be put down on.
        start: The first configuration, (n,).
    """

    def __init__(self, checks: PairChecks, *, supports: frozenset[str], start: Array) -> None:
        self._checks = checks
        self._least_m = np.full(len(checks.pairs), TOUCHING_M)
        self._supported = np.array([not supports.isdisjoint(pair) for pair in checks.pairs], dtype=np.bool_)
        self._resting = np.zeros(len(checks.pairs), dtype=np.bool_)
        if checks.in_collision(start):
            near = checks.distances(start)
            self._resting = near < TOUCHING_M
            # No slack beyond what contact may be: motion after motion would add to it.
            deepest = np.where(near > -CONTACT_M, np.maximum(near - _SLACK_M, -CONTACT_M), near - _EXACT_M)
            self._least_m[self._resting] = deepest[self._resting]

    def refused(self, joints: Array, *, at_end: bool) -> tuple[NamePair, ...]:
        """Return the names of the pairs, deepest first, that are nearer at `joints` (n,) than they may be."""
        if not self._resting.any() and not self._checks.in_collision(joints):
            return ()
        near = self._checks.distances(joints)
        parted = self._resting & (near > _SLACK_M)
        self._resting &= ~parted
        self._least_m[parted] = TOUCHING_M
        least = np.where(self._supported & at_end, np.minimum(self._least_m, -CONTACT_M), self._least_m)
        deepest = np.argsort(near, kind="stable")
        return tuple(dict.fromkeys(self._checks.pairs[int(k)] for k in deepest if near[k] < least[k]))


def _held_alone(scene: PlanningScene, arm: str) -> PlanningScene:
    """Return the scene in which nothing of the arm counts but what it holds."""
    names = [one.name for one in (*scene.arms, *scene.obstacles)]
    names += [part.name for part in scene.attached if part.arm != arm]
    return msgspec.structs.replace(scene, allowed=(*scene.allowed, *((arm, name) for name in names)))


def _ending(checker: ExactChecker, rows: Array, moved_m: Array) -> int:
    """Return the first row from which on nothing held is farther than `CONTACT_M` from where it is at last."""
    there = checker.held_points(rows[-1])
    later = len(rows) - 1
    for row in reversed(_rows_every(_FINE_M, moved_m)):
        if float(np.linalg.norm(checker.held_points(rows[row]) - there, axis=1).max(initial=0.0)) > CONTACT_M:
            return later
        later = row
    return 0


def _moved(checker: ExactChecker, rows: Array) -> Array:
    """Return how far the fastest point of the arm and of what it holds has moved at most up to each row, metres."""
    return np.concatenate(([0.0], np.cumsum(np.abs(np.diff(rows, axis=0)) @ checker.bound_m)))


def _rows_every(step_m: float, moved_m: Array) -> list[int]:
    """Return rows, the first one among them, between which nothing moves farther than a step, or by one row."""
    return sorted(set(np.searchsorted(moved_m, np.arange(0.0, float(moved_m[-1]) + step_m, step_m)[:-1]).tolist()))
