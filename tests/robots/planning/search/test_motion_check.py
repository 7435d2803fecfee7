"""A motion that was not planned is checked: what it is meant to touch is no collision, all else is."""

from __future__ import annotations

import numpy as np
import pytest

from engine.errors import CellError
from engine.messages.sensing import OccupancyGrid
from engine.skills.planning_scene import CONTACT_M
from robots.planning.request import PathCheck, PathCheckRequest, ToolContact
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import PlanningScene
from robots.planning.search.motion_check import check_motion
from robots.planning.search.path_check import SelfCollisionCache
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import Array, JointTrajectory
from tests.robots.planning.motion_oracle import MotionOracle
from tests.robots.planning.search.test_path_check import ARM, HOME, PANDA, WALL, WAY, box, grid_of, line, turned

PLANNER = ScenePlanner(check_s=2e-5)
BENT = turned(3, -0.4)
DOWN = line(HOME, BENT)
"""The hand comes nearer to what is below it."""


def check(
    way: JointTrajectory,
    *,
    scene: PlanningScene = PANDA,
    contact: ToolContact = "at_end",
    from_s: float = 0.0,
    occupancy: OccupancyGrid | None = None,
    planner: ScenePlanner = PLANNER,
) -> PathCheck:
    return planner.check_path(
        PathCheckRequest(scene=scene, arm=ARM, trajectory=way, from_s=from_s, tool_contact=contact, occupancy=occupancy)
    )


def lowest(joints: Array) -> Array:
    """Return the lowest corner of the tool."""
    corners = ExactChecker(PANDA, ARM).tool_points(joints)
    return corners[np.argmin(corners[:, 2])]


def below(joints: Array, *, deep_m: float) -> PlanningScene:
    """Return the scene with a plate that the tool touches at `joints`, so deep."""
    x, y, z = lowest(joints).tolist()
    return PANDA.with_obstacles(box("plate", (0.6, 0.6, 0.02), (x, y, z - 0.01 + deep_m)))


def test_a_free_motion_is_free_to_its_end() -> None:
    assert check(WAY) == PathCheck(blocked_at_s=None, pairs=(), looked_s=2.0)


@pytest.mark.parametrize("contact", ["never", "at_end"])
def test_what_is_on_the_path_blocks_where_mujoco_finds_the_contact(contact: ToolContact) -> None:
    scene = PANDA.with_obstacles(WALL)
    found = check(WAY, scene=scene, contact=contact)
    assert found.blocked_at_s is not None
    assert all("wall" in pair for pair in found.pairs)
    oracle = MotionOracle(scene, ARM)
    touched_s = next(k * WAY.dt_s for k, joints in enumerate(WAY.position_rad) if oracle.touches(joints))
    assert found.blocked_at_s == pytest.approx(touched_s, abs=0.02)


def test_the_tool_may_touch_at_the_end_and_no_deeper() -> None:
    assert check(DOWN, scene=below(BENT, deep_m=0.003)).blocked_at_s is None
    assert check(DOWN, scene=below(BENT, deep_m=0.003), contact="never").blocked_at_s is not None
    blocked_s = check(DOWN, scene=below(BENT, deep_m=3 * CONTACT_M)).blocked_at_s
    assert blocked_s is not None
    assert blocked_s < DOWN.duration_s


@pytest.mark.parametrize("deep_m", [0.8 * CONTACT_M, 0.95 * CONTACT_M, 1.02 * CONTACT_M, 1.1 * CONTACT_M])
def test_a_contact_that_begins_before_the_end_section_is_refused(deep_m: float) -> None:
    """Also where the row at which it begins is not looked at."""
    scene = below(BENT, deep_m=deep_m)
    checker, rows = ExactChecker(scene, ARM), DOWN.position_rad
    ways_m = np.linalg.norm(np.diff([checker.tool_points(row) for row in rows], axis=0), axis=2)
    # The way that the farthest moved point of the tool has left.
    left_m = np.cumsum(ways_m[::-1], axis=0)[::-1].max(axis=1)
    before = int(np.flatnonzero(left_m > CONTACT_M)[-1])
    assert (check(DOWN, scene=scene).blocked_at_s is not None) is checker.in_collision(rows[before])


def sampled(rows: Array) -> JointTrajectory:
    """Return a way through these configurations, a sample each 2 ms."""
    return JointTrajectory(dt_s=0.002, position_rad=rows, velocity_rad_s=np.zeros_like(rows))


def touched_first_at(row: int, rows: Array, *, deep_m: float) -> PlanningScene:
    """Return the scene with a plate that the tool touches at a row, so deep, and not at the row before."""
    x, y, z = lowest(rows[row]).tolist()

    def scene_at(raised_m: float) -> PlanningScene:
        return PANDA.with_obstacles(box("plate", (0.2, 0.2, 0.02), (x, y, z - 0.01 + raised_m)))

    low_m, high_m = -0.05, 0.02
    while high_m - low_m > 1e-5:
        middle_m = (low_m + high_m) / 2.0
        if ExactChecker(scene_at(middle_m), ARM).in_collision(rows[row]):
            high_m = middle_m
        else:
            low_m = middle_m
    scene = scene_at(high_m + deep_m)
    checker = ExactChecker(scene, ARM)
    assert [checker.in_collision(rows[k]) for k in (row - 1, row)] == [False, True]
    return scene


def left_m(rows: Array) -> Array:
    """Return how far the farthest moved point of the tool is from its end at each row."""
    points = ExactChecker(PANDA, ARM).tool_points
    return np.array([np.linalg.norm(points(row) - points(rows[-1]), axis=1).max() for row in rows])


@pytest.mark.parametrize("more", range(5))
def test_a_contact_that_begins_one_sample_before_the_end_section_is_refused(more: int) -> None:
    """Whichever of the samples are looked at."""
    rows = np.array([turned(3, by) for by in np.arange(-0.2 + 0.001 * more, -0.4, -0.001)])
    before = int(np.flatnonzero(left_m(rows) > CONTACT_M)[-1])
    scene = touched_first_at(before, rows, deep_m=0.0001)
    assert check(sampled(rows), scene=scene).blocked_at_s is not None


def test_a_contact_that_begins_with_the_end_section_is_meant() -> None:
    """The samples are so far apart that all are looked at."""
    fine = np.array([turned(3, by) for by in np.arange(-0.2, -0.4, -0.0005)])
    left = left_m(fine)
    rows = fine[[int(np.flatnonzero(left > share * CONTACT_M)[-1]) for share in (9.0, 4.0, 1.4, 0.8)] + [-1]]
    assert check(sampled(rows), scene=touched_first_at(3, rows, deep_m=0.0005)).blocked_at_s is None


def test_a_motion_that_is_shorter_than_the_end_section_may_touch_from_its_second_sample_on() -> None:
    fine = np.array([turned(3, by) for by in np.arange(-0.2, -0.4, -0.0005)])
    left = left_m(fine)
    rows = fine[[int(np.flatnonzero(left > share * CONTACT_M)[-1]) for share in (0.8, 0.4)] + [-1]]
    scene = touched_first_at(1, rows, deep_m=0.0005)
    assert check(sampled(rows), scene=scene).blocked_at_s is None
    assert check(sampled(rows), scene=scene, contact="never").blocked_at_s == 0.002


def test_a_contact_of_the_tool_ends_the_path_of_a_guarded_move_and_one_of_another_link_does_not() -> None:
    found = check(DOWN, scene=below(BENT, deep_m=0.05), contact="ends_path")
    assert found.blocked_at_s is None
    assert found.looked_s < DOWN.duration_s
    # The elbow swings into the wall first.
    high = PANDA.with_obstacles(box("wall", (0.3, 0.05, 0.6), (0.25, 0.1, 0.65)))
    elbow = check(WAY, scene=high, contact="ends_path")
    assert elbow.blocked_at_s is not None
    assert any("panda_link" in name for pair in elbow.pairs for name in pair)


def test_a_tool_that_presses_may_touch_all_along_its_path() -> None:
    scene = below(BENT, deep_m=0.05)
    assert check(DOWN, scene=scene, contact="along_path").blocked_at_s is None
    assert check(DOWN, scene=scene, contact="at_end").blocked_at_s is not None


def test_what_touches_at_the_start_may_be_left_and_not_be_pressed() -> None:
    scene = below(HOME, deep_m=0.002)
    assert check(line(HOME, turned(3, 0.4)), scene=scene).blocked_at_s is None
    assert check(DOWN, scene=scene).blocked_at_s is not None


@pytest.mark.parametrize(("gap_m", "is_free"), [(2e-5, True), (5e-4, False)])
def test_what_is_nearer_at_the_start_than_one_can_measure_touches_there(gap_m: float, *, is_free: bool) -> None:
    """A tool that hangs in its place leans on a rail by a hair more when it is lifted."""
    pressed = turned(3, -0.002)
    deep_m = float(lowest(HOME)[2] - lowest(pressed)[2])
    assert 6e-4 < deep_m < 1e-3
    scene = below(HOME, deep_m=-gap_m)
    found = check(sampled(np.array([HOME, pressed, turned(3, 0.4)])), scene=scene, contact="never")
    assert (found.blocked_at_s is None) is is_free


@pytest.mark.parametrize("contact", ["at_end", "ends_path", "along_path"])
def test_what_the_cameras_see_is_never_meant(contact: ToolContact) -> None:
    found = check(WAY, contact=contact, occupancy=grid_of(np.ones((5, 5, 5)), corner_m=(0.25, 0.0, 0.5)))
    assert found.blocked_at_s is not None
    assert "occupancy" in found.pairs[0]


def test_only_what_is_still_to_come_counts() -> None:
    scene = PANDA.with_obstacles(WALL)
    assert check(WAY, scene=scene, from_s=WAY.duration_s - 0.05).blocked_at_s is None
    assert check(WAY, scene=scene, from_s=0.2).blocked_at_s == check(WAY, scene=scene).blocked_at_s


def test_what_is_seen_ahead_of_a_check_that_begins_in_the_middle_is_found() -> None:
    """Where the path was known to be free, only the rows near what is seen are looked at exactly."""
    grid = grid_of(np.ones((4, 4, 4)), corner_m=(0.3, 0.2, 0.5))
    known = ScenePlanner(check_s=2e-5)
    assert check(WAY, planner=known, contact="never").blocked_at_s is None
    found = check(WAY, occupancy=grid, from_s=0.9, contact="never", planner=known)
    assert found.blocked_at_s is not None
    assert found.blocked_at_s > 1.2
    assert found == check(WAY, occupancy=grid, from_s=0.9, contact="never", planner=ScenePlanner(check_s=2e-5))


THERE_AND_BACK = JointTrajectory(
    dt_s=DOWN.dt_s,
    position_rad=np.vstack((line(HOME, turned(3, 0.4)).position_rad, line(turned(3, 0.4), BENT).position_rad)),
    velocity_rad_s=np.zeros((2 * len(DOWN.position_rad), 7)),
)
"""Away from what touches at the start, and then into it."""


@pytest.mark.parametrize("from_s", [0.0, 0.3])
@pytest.mark.parametrize(
    ("way", "scene"),
    [
        (WAY, PANDA),
        (WAY, PANDA.with_obstacles(WALL)),
        (DOWN, below(BENT, deep_m=0.003)),
        (DOWN, below(BENT, deep_m=3 * CONTACT_M)),
        (THERE_AND_BACK, below(HOME, deep_m=0.002)),
    ],
    ids=["free", "wall", "placed", "pressed", "left and pressed"],
)
def test_what_gets_into_a_path_that_was_free_is_found_as_in_a_new_one(
    way: JointTrajectory, scene: PlanningScene, from_s: float
) -> None:
    """Its self-collisions are not looked for again."""
    known = ScenePlanner(check_s=2e-5)
    assert check(way, planner=known) == PathCheck(blocked_at_s=None, pairs=(), looked_s=way.duration_s)
    new = check(way, scene=scene, from_s=from_s, planner=ScenePlanner(check_s=2e-5))
    assert check(way, scene=scene, from_s=from_s, planner=known) == new
    assert (new.blocked_at_s is None) is (scene in (PANDA, below(BENT, deep_m=0.003)))


def test_a_motion_of_another_arm_is_refused() -> None:
    with pytest.raises(CellError, match="a path of 6 joints does not fit this arm"):
        check(line(np.zeros(6), np.ones(6)))


@pytest.mark.parametrize(("scene", "is_recorded"), [(PANDA, True), (PANDA.with_obstacles(WALL), False)])
def test_only_a_motion_that_was_checked_to_its_end_is_recorded(scene: PlanningScene, *, is_recorded: bool) -> None:
    known = SelfCollisionCache()
    prepared = PLANNER.prepared(scene, ARM, margin_m=0.0, occupancy=None)
    request = PathCheckRequest(scene=scene, arm=ARM, trajectory=WAY, from_s=0.5, tool_contact="never")
    for _ in range(2):
        found = check_motion(request, lambda: prepared.checker, prepared.problem, known)
        assert (found.blocked_at_s is None) is is_recorded
        assert known.are_free(scene, ARM, WAY, 0.5) is is_recorded
        assert not known.are_free(scene, ARM, WAY, 0.49)


def test_after_its_end_a_motion_is_blocked_at_its_end() -> None:
    x, y, z = ExactChecker(PANDA, ARM).tool_points(WAY.position_rad[-1]).mean(axis=0).tolist()
    scene = PANDA.with_obstacles(box("shelf", (0.04, 0.04, 0.04), (x, y, z)))
    found = check(WAY, scene=scene, contact="never", from_s=99.0)
    assert (found.blocked_at_s, found.looked_s) == (2.0, 2.0)
