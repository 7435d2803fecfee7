"""Checks the attached parts of an arm for collisions on a trajectory that was planned without a scene.

A held part may touch

- what the scene allows;
- what it touches at the start, such as the table that it is lifted from: no deeper than there, until they separate.
  Nearer than 0.1 mm counts as touching there: no measurement tells the two apart;
- the obstacle or unheld part on which it is placed: at the end of the trajectory, where all of its points are within
  `CONTACT_M` of their final positions, and no deeper than that.

Every other contact is a collision: contact before the end of the trajectory, and contact with arms or their parts.
The arm itself is not checked.
"""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import numpy as np
from numpy.typing import NDArray

from engine.skills.planning_scene import CONTACT_M
from robots.model.robot_model import RobotModel
from robots.planning.request import AttachedPartCheckRequest, PathCheck
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.pair_checks import TOUCHING_M, PairChecks
from robots.planning.scene.planning_scene import NamePair, PlanningScene
from robots.planning.scene.static_scene import arm_in_scene
from robots.planning.search.path_check import require_fit
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement

Flags = NDArray[np.bool_]

_STEP_M, _FINE_M = 0.005, 0.0005
"""Largest motion of a held point between two checks, and the resolution of the start of the end section."""
_SLACK_M, _EXACT_M = 0.001, 1e-4
"""An initial contact may deepen by the first before separation, and counts as separated at that distance; the second is
the accuracy of distances of overlapping shapes, and what is nearer at the start touches there."""


def check_attached_parts(
    request: AttachedPartCheckRequest, *, robot: Callable[[ArmPlacement], RobotModel]
) -> PathCheck:
    """Return the first collision of an attached part on a trajectory; `robot` loads models.

    Raises:
        CellError: the scene has no such arm or is invalid, or the trajectory does not fit the arm.
    """
    scene = _attached_parts_only(request.scene, request.arm)
    checker = ExactChecker(scene, request.arm, among=arm_in_scene(scene, request.arm, robot=robot))
    trajectory = request.trajectory
    require_fit(trajectory, arm=request.arm, dof=checker.dof)
    rows = trajectory.position_rad
    checks = checker.checks[0]
    moved_m = largest_motion_m(checker, rows)
    end_row = end_section_start(checker.held_points, rows, moved_m)
    contacts = AllowedContacts(checks, placed=placing_pairs(checks, scene), start=rows[0])
    # The row before the end section shows whether a contact precedes it.
    for row in sorted({*_rows_every(_STEP_M, moved_m), max(0, end_row - 1), len(rows) - 1}):
        touching = contacts.refused(rows[row], at_end=row >= end_row)
        if touching:
            at_s = row * trajectory.dt_s
            return PathCheck(blocked_at_s=at_s, pairs=touching, looked_s=at_s)
    return PathCheck(blocked_at_s=None, pairs=(), looked_s=trajectory.duration_s)


def placing_pairs(checks: PairChecks, scene: PlanningScene, *, bodies: frozenset[str] | None = None) -> Flags:
    """Return which pairs are of one of `bodies`, or of any body, with an obstacle or a part that no arm holds."""
    supports = frozenset(one.name for one in scene.obstacles)
    return np.array(
        [not supports.isdisjoint(pair) and (bodies is None or not bodies.isdisjoint(pair)) for pair in checks.pairs],
        dtype=np.bool_,
    )


class AllowedContacts:
    """Finds forbidden contacts, configuration after configuration along a trajectory.

    What touches at the start may go on touching, no deeper than there, until it has separated.

    Args:
        checks: The pairs.
        placed: Which of them may touch at the end of the trajectory, up to `CONTACT_M` deep.
        start: The first configuration, (n,).
    """

    def __init__(self, checks: PairChecks, *, placed: Flags, start: Array) -> None:
        self._checks = checks
        self._least_m = np.full(len(checks.pairs), TOUCHING_M)
        self._placed = placed
        distances = checks.distances(start)
        self._resting = distances < _EXACT_M
        # No slack beyond the allowed contact depth: it would accumulate over motions.
        deepest = np.where(distances > -CONTACT_M, np.maximum(distances - _SLACK_M, -CONTACT_M), distances - _EXACT_M)
        self._least_m[self._resting] = deepest[self._resting]

    @property
    def resting(self) -> bool:
        """Whether something that touches at the start still touches."""
        return bool(self._resting.any())

    def refused(self, joints: Array, *, at_end: bool) -> tuple[NamePair, ...]:
        """Return the names of the pairs, deepest first, that are nearer at `joints` (n,) than allowed."""
        return tuple(dict.fromkeys(pair for pair, _ in self.too_near(joints, at_end=at_end)))

    def too_near(self, joints: Array, *, at_end: bool) -> list[tuple[NamePair, bool]]:
        """Return the pairs, deepest first, that are nearer at `joints` than allowed, and which of them are `placed`."""
        if not self._resting.any() and not self._checks.in_collision(joints):
            return []
        distances = self._checks.distances(joints)
        separated = self._resting & (distances > _SLACK_M)
        self._resting &= ~separated
        self._least_m[separated] = TOUCHING_M
        least = np.where(self._placed & at_end, np.minimum(self._least_m, -CONTACT_M), self._least_m)
        deepest = np.argsort(distances, kind="stable")
        return [(self._checks.pairs[int(k)], bool(self._placed[k])) for k in deepest if distances[k] < least[k]]


def _attached_parts_only(scene: PlanningScene, arm: str) -> PlanningScene:
    """Return the scene in which only the attached parts of the arm are checked."""
    names = [one.name for one in (*scene.arms, *scene.obstacles)]
    names += [part.name for part in scene.attached if part.arm != arm]
    return msgspec.structs.replace(scene, allowed=(*scene.allowed, *((arm, name) for name in names)))


def end_section_start(points: Callable[[Array], Array], rows: Array, moved_m: Array) -> int:
    """Return the first row of the end section, where all `points` (k, 3) are within `CONTACT_M` of their ends."""
    final = points(rows[-1])
    later = len(rows) - 1
    for row in reversed(_rows_every(_FINE_M, moved_m)):
        if float(np.linalg.norm(points(rows[row]) - final, axis=1).max(initial=0.0)) > CONTACT_M:
            return later
        later = row
    return 0


def largest_motion_m(checker: ExactChecker, rows: Array) -> Array:
    """Return an upper bound of the motion of any point of the arm and its parts up to each row, meters."""
    return np.concatenate(([0.0], np.cumsum(np.abs(np.diff(rows, axis=0)) @ checker.bound_m)))


def _rows_every(step_m: float, moved_m: Array) -> list[int]:
    """Return rows including the first, between which no point moves farther than a step; at least every row."""
    return sorted(set(np.searchsorted(moved_m, np.arange(0.0, float(moved_m[-1]) + step_m, step_m)[:-1]).tolist()))
