"""What is known of paths without self-collision; the instants and bodies that a check names at both ends of a path."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from engine.errors import CellError
from robots.planning.request import PathCheckRequest
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene
from robots.planning.search.path_check import SelfCollisionCache, check_path, require_fit
from robots.port import JointTrajectory
from tests.robots.planning.search.test_path_check import (
    ARM,
    PANDA,
    PLANNER,
    WALL,
    WAY,
    box,
    check,
    line,
    turned,
)

KEPT = 16
_END = ExactChecker(PANDA, ARM).tool_points(WAY.position_rad[-1]).mean(axis=0).tolist()
AT_THE_END = box("shelf", (0.04, 0.04, 0.04), (_END[0], _END[1], _END[2]))


def _path(number: int) -> JointTrajectory:
    return line(turned(0, -1.0), turned(0, 0.01 * number), duration_s=0.01)


def test_a_path_is_known_from_the_earliest_instant_on_that_was_recorded() -> None:
    known = SelfCollisionCache()
    assert known.are_free(PANDA, ARM, WAY, 9.0) is False
    known.add(PANDA, ARM, WAY, 0.5)
    assert [known.are_free(PANDA, ARM, WAY, at_s) for at_s in (0.49, 0.5, 0.6)] == [False, True, True]
    known.add(PANDA, ARM, WAY, 0.8)
    assert known.are_free(PANDA, ARM, WAY, 0.5)
    known.add(PANDA, ARM, WAY, 0.2)
    assert known.are_free(PANDA, ARM, WAY, 0.2)


def test_the_latest_sixteen_paths_are_kept() -> None:
    known = SelfCollisionCache()
    for number in range(KEPT):
        known.add(PANDA, ARM, _path(number), 0.0)
    assert all(known.are_free(PANDA, ARM, _path(number), 0.0) for number in range(KEPT))
    # One that is recorded again is the latest.
    known.add(PANDA, ARM, _path(0), 0.0)
    known.add(PANDA, ARM, _path(KEPT), 0.0)
    kept = [number for number in range(KEPT + 1) if known.are_free(PANDA, ARM, _path(number), 0.0)]
    assert kept == [0, *range(2, KEPT + 1)]


def test_the_arm_what_it_holds_and_what_may_touch_belong_to_a_path_and_nothing_else() -> None:
    known = SelfCollisionCache()
    known.add(PANDA, ARM, WAY, 0.0)
    moved = msgspec.structs.replace(
        PANDA, arms=tuple(msgspec.structs.replace(arm, joints_rad=(0.1,) * 7) for arm in PANDA.arms)
    )
    others: tuple[tuple[PlanningScene, bool], ...] = (
        (moved, True),
        (PANDA.with_obstacles(WALL), True),
        (PANDA.with_attached(AttachedPart(name="rod", arm=ARM, solids=WALL.solids)), False),
        (PANDA.with_allowed(ARM, "wall"), False),
    )
    assert [known.are_free(scene, ARM, WAY, 0.0) for scene, _ in others] == [is_known for _, is_known in others]


@pytest.mark.parametrize(("scene", "is_recorded"), [(PANDA, True), (PANDA.with_obstacles(WALL), False)])
def test_only_a_path_that_was_checked_to_its_end_is_recorded(scene: PlanningScene, *, is_recorded: bool) -> None:
    known = SelfCollisionCache()
    prepared = PLANNER.prepared(scene, ARM, margin_m=0.0, occupancy=None)
    request = PathCheckRequest(scene=scene, arm=ARM, trajectory=WAY, from_s=0.5)
    for _ in range(2):
        found = check_path(request, prepared.checker, prepared.problem, known)
        assert (found.blocked_at_s is None) is is_recorded
        assert known.are_free(scene, ARM, WAY, 0.5) is is_recorded
        assert not known.are_free(scene, ARM, WAY, 0.49)


def test_an_arm_that_begins_within_one_body_names_it_and_not_what_is_at_the_end() -> None:
    scene = PANDA.with_obstacles(WALL, AT_THE_END)
    blocked_s = check(WAY, scene=scene).blocked_at_s
    assert blocked_s is not None
    from_s = blocked_s + 0.1
    assert {pair[1] for pair in check(WAY, scene=scene, from_s=1.999).pairs} == {"shelf"}
    found = check(WAY, scene=scene, from_s=from_s)
    assert found.blocked_at_s == pytest.approx(from_s)
    assert {pair[1] for pair in found.pairs} == {"wall"}


def test_after_its_end_a_path_is_blocked_at_its_end() -> None:
    found = check(WAY, scene=PANDA.with_obstacles(AT_THE_END), from_s=99.0)
    assert (found.blocked_at_s, found.looked_s) == (2.0, 2.0)


@pytest.mark.parametrize("rows", [np.zeros(7), np.zeros((0, 7)), np.zeros((3, 6))], ids=["flat", "empty", "six joints"])
def test_rows_that_do_not_fit_are_refused(rows: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> None:
    way = JointTrajectory(dt_s=0.01, position_rad=rows, velocity_rad_s=rows)
    with pytest.raises(CellError, match=r"does not fit this arm \(it has 7\)"):
        require_fit(way, arm=ARM, dof=7)
