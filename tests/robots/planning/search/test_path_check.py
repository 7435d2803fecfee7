"""A way is checked from an instant on: what touches first is found, nothing else stops the arm."""

from __future__ import annotations

import itertools

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.planning_scenes import ARM, alone, box, cases
from engine.errors import CellError
from engine.messages import Pose
from engine.messages.sensing import OccupancyGrid
from engine.messages.shapes import Box, Solid, Sphere
from robots.planning.request import (
    CollisionRequest,
    JointGoal,
    PathCheck,
    PathCheckRequest,
    PathPlan,
    PlanRequest,
)
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import Array, JointTrajectory
from tests.robots.planning.motion_oracle import MotionOracle
from tests.robots.planning.scene.test_voxels import LOWER, UPPER, VOXEL_M, grid_of

PLANNER = ScenePlanner(check_s=2e-5)
PANDA = alone("panda")
HOME = np.array(ExactChecker(PANDA, ARM).model.home_rad)
SHELF = cases()[-1].request


def line(start: Array, end: Array, *, duration_s: float = 2.0) -> JointTrajectory:
    """Return a straight way at rest at both ends, a sample each 2 ms."""
    share = np.linspace(0.0, 1.0, round(duration_s / 0.002) + 1)[:, None]
    smooth = 3.0 * share**2 - 2.0 * share**3
    rate = 6.0 * share * (1.0 - share) / duration_s
    return JointTrajectory(dt_s=0.002, position_rad=start + smooth * (end - start), velocity_rad_s=rate * (end - start))


def turned(joint: int, by: float) -> Array:
    joints = HOME.copy()
    joints[joint] += by
    return joints


def check(
    way: JointTrajectory,
    *,
    scene: PlanningScene = PANDA,
    from_s: float = 0.0,
    occupancy: OccupancyGrid | None = None,
    margin_m: float = 0.0,
    planner: ScenePlanner = PLANNER,
) -> PathCheck:
    return planner.check_path(
        PathCheckRequest(scene=scene, arm=ARM, trajectory=way, from_s=from_s, occupancy=occupancy, margin_m=margin_m)
    )


def first_touch_s(checker: ExactChecker, way: JointTrajectory, from_s: float = 0.0) -> float | None:
    """Return the first sample at which anything touches, by looking at all of them."""
    for k, joints in enumerate(way.position_rad):
        if k * way.dt_s >= from_s and checker.in_collision(joints):
            return k * way.dt_s
    return None


WAY = line(turned(0, -1.2), turned(0, 1.2))
WALL = box("wall", (0.3, 0.05, 0.6), (0.4, 0.1, 0.3))


def test_a_free_way_is_free_to_its_end() -> None:
    assert check(WAY) == PathCheck(blocked_at_s=None, pairs=(), looked_s=2.0)


def test_the_first_touch_of_an_obstacle_is_found_to_the_sample() -> None:
    scene = PANDA.with_obstacles(WALL)
    exact_s = first_touch_s(ExactChecker(scene, ARM), WAY)
    found = check(WAY, scene=scene)
    assert found.blocked_at_s == exact_s == found.looked_s
    assert found.pairs
    assert all("wall" in pair for pair in found.pairs)


@pytest.mark.parametrize("y_m", np.linspace(0.102, 0.108, 7).tolist())
def test_the_first_touch_is_found_to_the_sample_wherever_it_lies_between_two_looks(y_m: float) -> None:
    scene = PANDA.with_obstacles(box("wall", (0.3, 0.05, 0.6), (0.4, y_m, 0.3)))
    assert check(WAY, scene=scene).blocked_at_s == first_touch_s(ExactChecker(scene, ARM), WAY)


def test_only_what_is_still_to_come_counts() -> None:
    scene = PANDA.with_obstacles(WALL)
    blocked_s = check(WAY, scene=scene).blocked_at_s
    assert blocked_s is not None
    checker = ExactChecker(scene, ARM)
    through_s = next(
        k * WAY.dt_s
        for k, joints in enumerate(WAY.position_rad)
        if k * WAY.dt_s > blocked_s and not checker.in_collision(joints)
    )
    assert check(WAY, scene=scene, from_s=blocked_s + 0.1).blocked_at_s == pytest.approx(blocked_s + 0.1)
    assert check(WAY, scene=scene, from_s=through_s).blocked_at_s is None
    assert check(WAY, scene=scene, from_s=99.0) == PathCheck(blocked_at_s=None, pairs=(), looked_s=2.0)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), from_s=st.floats(0.0, 1.5), margin_m=st.sampled_from([0.0, 0.02]))
def test_what_a_brute_force_finds_in_random_clutter_is_found(seed: int, from_s: float, margin_m: float) -> None:
    random = np.random.default_rng(seed)
    ends = LOWER + random.random((2, 7)) * (UPPER - LOWER)
    way = line(*ends)
    scene = PANDA.with_obstacles(
        *(box(f"box_{k}", (0.2, 0.1, 0.1), tuple(random.uniform(-0.8, 0.8, 3).tolist())) for k in range(3))
    )
    taken = (random.random((10, 10, 10)) < 0.01).astype(np.float64)
    grid = grid_of(taken, corner_m=tuple(random.uniform(-0.7, 0.5, 3).tolist()), voxel_m=0.04)
    checker = PLANNER.prepared(scene, ARM, margin_m=margin_m, occupancy=grid).checker
    found = check(way, scene=scene, from_s=from_s, occupancy=grid, margin_m=margin_m)
    first = int(from_s / way.dt_s) * way.dt_s
    exact_s = first_touch_s(checker, way, first)
    if exact_s == pytest.approx(first):
        # Where the arm begins within the margin only it may leave: other tests look at that.
        assert margin_m > 0.0 or found.blocked_at_s == pytest.approx(from_s)
        return
    if found.blocked_at_s is not None:
        # No false stop, and none too late by more than the step between two looks.
        at = way.position_rad[round(found.blocked_at_s / way.dt_s)]
        assert checker.in_collision(at)
        assert set(found.pairs) == set(checker.colliding_pairs(at))
        assert exact_s is not None
        between = way.position_rad[[round(exact_s / way.dt_s), round(found.blocked_at_s / way.dt_s)]]
        assert exact_s <= found.blocked_at_s
        assert exact_s == pytest.approx(found.blocked_at_s) or _grazed(checker, way, exact_s, found.blocked_at_s), (
            between
        )
    elif exact_s is not None:
        assert _grazed(checker, way, exact_s, 2.0)


def _grazed(checker: ExactChecker, way: JointTrajectory, first_s: float, until_s: float) -> bool:
    """Return whether all touches in a time are so short that no point of the arm moves a step meanwhile."""
    rows = way.position_rad[round(first_s / way.dt_s) : round(until_s / way.dt_s)]
    longest = run = 0.0
    for before, after in itertools.pairwise(rows):
        run = run + float(np.abs(after - before) @ checker.bound_m) if checker.in_collision(after) else 0.0
        longest = max(longest, run)
    return longest <= checker.step_m


def test_an_arm_that_would_touch_itself_is_found_although_only_the_exact_checker_can_decide() -> None:
    way = line(np.array([0.0, 0.0, 0.0, -1.5, 0.0, 1.6, 0.0]), np.array([0.0, 1.2, 0.0, -3.0, 0.0, 0.1, 0.0]))
    checker = ExactChecker(PANDA, ARM)
    exact_s = first_touch_s(checker, way)
    assert exact_s is not None
    found = check(way)
    assert found.blocked_at_s == exact_s
    assert all(first.startswith(ARM) and second.startswith(ARM) for first, second in found.pairs)
    again = check(way)
    assert again == found


def test_a_part_taken_into_the_hand_makes_a_known_way_a_new_one() -> None:
    way = line(HOME, turned(3, -0.6))
    assert check(way).blocked_at_s is None
    rod = Solid(shape=Box(size_m=(1.2, 0.02, 0.02)), pose=Pose(xyz=(0.0, 0.0, 0.02)))
    held = PANDA.with_attached(AttachedPart(name="rod", arm=ARM, solids=(rod,)))
    found = check(way, scene=held)
    assert found.blocked_at_s == first_touch_s(ExactChecker(held, ARM), way)


def test_a_way_that_was_planned_is_free_in_its_own_scene() -> None:
    answer = PLANNER.plan(msgspec.structs.replace(SHELF, speed=0.5))
    assert isinstance(answer, PathPlan)
    assert answer.timed is not None
    found = check(answer.timed, scene=SHELF.scene)
    assert found.blocked_at_s is None
    assert MotionOracle(SHELF.scene, ARM).first_touch(answer.timed.position_rad) is None


def test_what_the_check_says_is_what_mujoco_finds() -> None:
    """The first touch is where the simulator's contacts begin, within what the shapes differ by."""
    scene = PANDA.with_obstacles(WALL)
    blocked_s = check(WAY, scene=scene).blocked_at_s
    assert blocked_s is not None
    oracle = MotionOracle(scene, ARM)
    touched_s = next(k * WAY.dt_s for k, joints in enumerate(WAY.position_rad) if oracle.touches(joints))
    assert blocked_s == pytest.approx(touched_s, abs=0.01)


def test_what_comes_into_view_blocks_and_what_may_touch_it_does_not() -> None:
    grid = grid_of(np.ones((5, 5, 5)), corner_m=(0.25, 0.0, 0.5))
    found = check(WAY, occupancy=grid)
    assert found.blocked_at_s is not None
    assert {pair[1] for pair in found.pairs} == {"occupancy"}
    assert check(WAY, scene=PANDA.with_allowed(ARM, "occupancy"), occupancy=grid).blocked_at_s is None


def test_an_arm_within_the_margin_may_go_away_but_not_nearer() -> None:
    scene = PANDA.with_obstacles(WALL)
    blocked_s = check(WAY, scene=scene).blocked_at_s
    assert blocked_s is not None
    standing = WAY.position_rad[round(blocked_s / WAY.dt_s) - 20]
    gap_m = ExactChecker(scene, ARM).clearance(standing).distance_m
    assert 0.0 < gap_m < 0.04
    away = check(line(standing, turned(0, -1.2)), scene=scene, margin_m=0.05)
    assert away.blocked_at_s is None
    nearer = check(line(standing, turned(0, 0.0)), scene=scene, margin_m=0.05)
    assert nearer.blocked_at_s is not None
    assert nearer.blocked_at_s < 0.5
    # Once it has left, the whole margin counts.
    back = WAY.position_rad[round(blocked_s / WAY.dt_s) - 150]
    out, into = line(standing, back), line(back, standing)
    there = JointTrajectory(
        dt_s=0.002,
        position_rad=np.vstack((out.position_rad, into.position_rad)),
        velocity_rad_s=np.vstack((out.velocity_rad_s, into.velocity_rad_s)),
    )
    returned = check(there, scene=scene, margin_m=0.05)
    assert returned.blocked_at_s is not None
    assert returned.blocked_at_s > 2.0


@pytest.mark.parametrize("by_rad", np.linspace(0.2, 0.24, 5).tolist())
def test_an_arm_that_leaves_the_margin_within_one_step_may_not_come_back_into_it(by_rad: float) -> None:
    """A ball far out on the hand moves by more than what its spheres extend beyond it."""
    ball = Solid(shape=Sphere(radius_m=0.01), pose=Pose(xyz=(0.0, 0.0, 1.0)))
    held = PANDA.with_attached(AttachedPart(name="ball", arm=ARM, solids=(ball,)))
    checker = ExactChecker(held, ARM)
    middle, moved = (checker.held_points(turned(5, by)).mean(axis=0) for by in (0.0, 1e-3))
    ahead = (moved - middle) / np.linalg.norm(moved - middle)
    # Its surface is 47 mm from that of the ball.
    wall = box("wall", (0.1, 0.1, 0.1), tuple((middle - (0.01 + 0.047 + 0.05) * ahead).tolist()))
    out, back = line(HOME, turned(5, by_rad)), line(turned(5, by_rad), HOME)
    there = JointTrajectory(
        dt_s=0.002,
        position_rad=np.vstack((out.position_rad, back.position_rad)),
        velocity_rad_s=np.vstack((out.velocity_rad_s, back.velocity_rad_s)),
    )
    assert check(out, scene=held.with_obstacles(wall), margin_m=0.05).blocked_at_s is None
    returned = check(there, scene=held.with_obstacles(wall), margin_m=0.05)
    assert returned.pairs == (("ball", "wall"),)
    assert returned.blocked_at_s is not None
    assert 3.8 < returned.blocked_at_s < 3.9


def test_the_same_check_has_the_same_answer_whatever_was_asked_before() -> None:
    scene = PANDA.with_obstacles(WALL)
    grid = grid_of(np.ones((5, 5, 5)), corner_m=(0.25, -0.3, 0.5))
    for planner in (PLANNER, ScenePlanner()):
        first = check(WAY, scene=scene, occupancy=grid, planner=planner)
        check(WAY, planner=planner)
        assert check(WAY, scene=scene, occupancy=grid, planner=planner) == first


def test_a_way_of_another_arm_is_refused() -> None:
    with pytest.raises(CellError, match="a path of 6 joints does not fit this arm"):
        check(line(np.zeros(6), np.ones(6)))


def test_a_look_says_what_touches_and_how_near_the_rest_is() -> None:
    scene = PANDA.with_obstacles(WALL)
    free = PLANNER.look(CollisionRequest(scene=scene, arm=ARM, joints_rad=tuple(turned(0, -1.2).tolist())))
    assert free.touching == ()
    assert free.distance_m > 0.05
    grid = grid_of(np.ones((5, 5, 5)), corner_m=(0.25, -0.05, 0.5))
    seen = PLANNER.look(CollisionRequest(scene=PANDA, arm=ARM, joints_rad=tuple(HOME.tolist()), occupancy=grid))
    assert {pair.second for pair in seen.touching} == {"occupancy"}
    assert seen.nearest[1] == "occupancy"
    assert seen.distance_m < 0.0
    with pytest.raises(CellError, match="give 7 joints"):
        PLANNER.look(CollisionRequest(scene=PANDA, arm=ARM, joints_rad=(0.0,)))


def test_a_plan_goes_around_what_cameras_see() -> None:
    grid = grid_of(np.ones((6, 4, 20)), corner_m=(0.25, -0.04, 0.3))
    request = PlanRequest(
        scene=PANDA,
        arm=ARM,
        start_rad=tuple(turned(0, -1.2).tolist()),
        goal=JointGoal(joints_rad=(tuple(turned(0, 1.2).tolist()),)),
        occupancy=grid,
        margin_m=0.01,
        speed=0.5,
    )
    answer = PLANNER.plan(request)
    assert isinstance(answer, PathPlan), answer
    assert len(answer.path) > 2
    assert answer.timed is not None
    side = (6 * VOXEL_M, 4 * VOXEL_M, 20 * VOXEL_M)
    middle = (0.25 + side[0] / 2, -0.04 + side[1] / 2, 0.3 + side[2] / 2)
    oracle = MotionOracle(PANDA.with_obstacles(box("seen", side, middle)), ARM, margin_m=0.01)
    assert oracle.first_touch(answer.path) is None
    assert oracle.first_touch(answer.timed.position_rad) is None
    assert check(answer.timed, occupancy=grid).blocked_at_s is None
    again = PLANNER.plan(request)
    assert isinstance(again, PathPlan)
    assert again.waypoints_rad == answer.waypoints_rad
