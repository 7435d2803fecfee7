"""An arm that stands nearer to something than the margin is planned for: it leaves, and the margin grows back."""

from __future__ import annotations

import re

import msgspec
import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, alone, box
from engine.errors import CellError
from engine.messages import Pose
from engine.messages.sensing import OccupancyGrid
from engine.messages.shapes import Obstacle, Sphere
from robots.planning.request import (
    JointGoal,
    PathGoal,
    PathOrientationConstraint,
    PathPlan,
    PlanAnswer,
    PlanRefusal,
    PlanRequest,
)
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import PlanningScene
from robots.planning.search.escape import EscapeChecker
from robots.planning.worker.scene_planner import GIVEN_PATH, ScenePlanner
from robots.port import Array
from tests.robots.planning.motion_oracle import MotionOracle, fine_steps
from tests.robots.planning.scene.test_voxels import VOXEL_M, grid_of

PLANNER = ScenePlanner(check_s=2e-5)
PANDA = alone("panda")
HOME: tuple[float, ...] = ExactChecker(PANDA, ARM).model.home_rad
AWAY = (1.3, *HOME[1:])
MARGIN_M = 0.04


def beside(gap_m: float) -> PlanningScene:
    """Return the scene of a block that long before the wrist of the arm at home."""
    far = PANDA.with_obstacles(box("block", (0.2, 0.2, 0.2), (0.6, 0.0, 0.5)))
    near = 0.6 - ExactChecker(far, ARM).clearance(np.array(HOME)).distance_m + gap_m
    return PANDA.with_obstacles(box("block", (0.2, 0.2, 0.2), (near, 0.0, 0.5)))


def request(scene: PlanningScene, goal: tuple[float, ...] = AWAY) -> PlanRequest:
    return PlanRequest(
        scene=scene, arm=ARM, start_rad=HOME, goal=JointGoal(joints_rad=(goal,)), margin_m=MARGIN_M, speed=0.5
    )


def gaps_along(scene: PlanningScene, path: Array) -> list[float]:
    """Return the clearance along a way in fine steps, as MuJoCo measures it; infinite beyond twice the margin."""
    oracle = MotionOracle(scene, ARM, margin_m=2.0 * MARGIN_M)
    return [oracle.gap_m(joints) for joints in fine_steps(path)]


def path_of(answer: PlanAnswer) -> Array:
    assert isinstance(answer, PathPlan), answer
    return answer.path


@pytest.mark.parametrize("gap_m", [0.0003, 0.003, 0.02, 0.039])
@pytest.mark.parametrize("goal", [AWAY, (-1.0, -0.2, *HOME[2:])])
def test_a_start_within_the_margin_is_left_and_the_margin_kept_from_there_on(
    gap_m: float, goal: tuple[float, ...]
) -> None:
    scene = beside(gap_m)
    answer = PLANNER.plan(request(scene, goal))
    path = path_of(answer)
    assert tuple(path[0]) == HOME
    assert tuple(path[-1]) == goal
    gaps = gaps_along(scene, path)
    assert min(gaps) > gap_m - 2e-3
    left = next(k for k, gap in enumerate(gaps) if gap >= MARGIN_M)
    assert min(gaps[left:]) > MARGIN_M - 2e-3
    assert isinstance(answer, PathPlan)
    assert answer.timed is not None
    assert min(gaps_along(scene, answer.timed.position_rad[::10])[-20:]) > MARGIN_M - 2e-3


def test_what_is_left_may_be_what_cameras_see() -> None:
    first_free = next(
        x
        for x in np.arange(0.5, 0.8, 0.005).tolist()
        if not PLANNER.prepared(PANDA, ARM, occupancy=_seen(x)).checker.in_collision(np.array(HOME))
    )
    answer = PLANNER.plan(msgspec.structs.replace(request(PANDA), occupancy=_seen(first_free)))
    path = path_of(answer)
    assert len(path) > 2
    side_m = 10 * VOXEL_M
    middle = (first_free - 0.1 + side_m / 2, -0.1 + side_m / 2, 0.4 + side_m / 2)
    block = box("seen", (side_m, side_m, side_m), middle)
    oracle = MotionOracle(PANDA.with_obstacles(block), ARM, margin_m=MARGIN_M)
    assert oracle.first_touch(path[1:]) is None
    assert MotionOracle(PANDA.with_obstacles(block), ARM).first_touch(path) is None


def _seen(x: float) -> OccupancyGrid:
    return grid_of(np.ones((10, 10, 10)), corner_m=(x - 0.1, -0.1, 0.4))


def test_a_start_that_touches_is_refused_whatever_the_margin() -> None:
    answer = PLANNER.plan(request(beside(-0.01)))
    assert isinstance(answer, PlanRefusal)
    assert answer.reason == "start_in_collision"
    assert all("block" in pair for pair in answer.pairs)


def test_where_there_is_no_way_out_of_the_margin_that_is_said() -> None:
    scene = PANDA.with_obstacles(Obstacle.of("ball", Sphere(radius_m=0.05), Pose(xyz=(0.0, 0.0, 0.25))))
    answer = PLANNER.plan(msgspec.structs.replace(request(scene.with_allowed(ARM, "nothing")), margin_m=3.0))
    assert isinstance(answer, PlanRefusal)
    assert answer.reason in ("start_in_collision", "goal_in_collision")
    assert answer.hint


def test_a_goal_within_the_margin_is_refused() -> None:
    answer = PLANNER.plan(msgspec.structs.replace(request(beside(0.02), HOME), start_rad=AWAY))
    assert isinstance(answer, PlanRefusal)
    assert answer.reason == "goal_in_collision"
    # What was asked for and what is: both numbers.
    found = re.search(r"is ([\d.]+) mm from block, nearer than the margin of 40 mm", answer.message)
    assert found is not None, answer.message
    assert float(found[1]) == pytest.approx(20.0, abs=1.5)
    assert "reduce the margin" in answer.hint


def test_what_touches_is_said_to_touch_whatever_the_margin() -> None:
    answer = PLANNER.plan(msgspec.structs.replace(request(beside(-0.01), HOME), start_rad=AWAY))
    assert isinstance(answer, PlanRefusal)
    assert "touches block" in answer.message


def test_leaving_ends_where_the_whole_margin_is_kept_for_once() -> None:
    scene = beside(0.02)
    checker = ExactChecker(scene, ARM, margin_m=MARGIN_M)
    home = np.array(HOME)
    leaving = EscapeChecker(checker, home)
    assert not leaving.in_collision(home)
    assert leaving.within_margin
    assert not leaving.in_collision(np.array(AWAY))
    assert not leaving.within_margin
    assert leaving.in_collision(home)
    assert leaving.colliding_pairs(home) == checker.colliding_pairs(home)


def test_the_same_start_is_left_along_the_same_way() -> None:
    scene = beside(0.003)
    first, second = (path_of(ScenePlanner(check_s=2e-5).plan(request(scene))) for _ in range(2))
    assert np.array_equal(first, second)


def given_path(scene: PlanningScene, *rows: tuple[float, ...], **changes: object) -> PlanAnswer:
    base = msgspec.structs.replace(request(scene), margin_m=0.0, goal=PathGoal(waypoints_rad=rows))
    return PLANNER.plan(msgspec.structs.replace(base, **changes))


MIDDLE = (0.6, -0.5, *HOME[2:])
BACK = (0.0, -1.3, *HOME[2:])


def test_a_given_way_is_confirmed_and_timed_as_it_is() -> None:
    answer = given_path(beside(0.1), HOME, MIDDLE, AWAY)
    assert isinstance(answer, PathPlan)
    assert answer.waypoints_rad == (HOME, MIDDLE, AWAY)
    assert answer.stats.found_by == GIVEN_PATH
    assert answer.timed is not None
    rows = answer.timed.position_rad
    assert tuple(rows[0]) == HOME
    assert tuple(rows[-1]) == AWAY
    assert float(np.linalg.norm(rows - np.array(MIDDLE), axis=1).min()) < 0.06


def test_a_given_way_that_is_blocked_is_refused_with_what_is_in_it() -> None:
    scene = PANDA.with_obstacles(box("wall", (0.3, 0.05, 0.6), (0.2, 0.35, 0.5)))
    answer = given_path(scene, HOME, MIDDLE, AWAY)
    assert isinstance(answer, PlanRefusal)
    assert answer.reason == "way_blocked"
    assert all("wall" in pair for pair in answer.pairs)
    assert "from waypoint" in answer.message


def test_a_given_way_may_begin_within_the_margin() -> None:
    assert isinstance(given_path(beside(0.02), HOME, BACK, margin_m=MARGIN_M), PathPlan)
    back = given_path(beside(0.02), HOME, BACK, HOME, margin_m=MARGIN_M)
    assert isinstance(back, PlanRefusal)
    assert back.reason == "way_blocked"


def test_a_given_way_that_cannot_be_is_refused_with_the_reason() -> None:
    touching = given_path(beside(-0.01), HOME, AWAY)
    assert isinstance(touching, PlanRefusal)
    assert touching.reason == "start_in_collision"
    outside = given_path(PANDA, HOME, (9.0, *HOME[1:]))
    assert isinstance(outside, PlanRefusal)
    assert outside.reason == "goal_outside_limits"
    assert "waypoint 1" in outside.message
    tilted = given_path(PANDA, HOME, (*HOME[:5], HOME[5] + 0.5, HOME[6]), keep_orientation=PathOrientationConstraint())
    assert isinstance(tilted, PlanRefusal)
    assert tilted.reason == "way_blocked"
    assert isinstance(
        given_path(PANDA, HOME, AWAY, keep_orientation=PathOrientationConstraint(free_about=(0, 0, 1))), PathPlan
    )
    with pytest.raises(CellError, match="does not begin at the start configuration"):
        given_path(PANDA, AWAY, HOME)
