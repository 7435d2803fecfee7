"""Planners find confirmed ways, the same ones for the same seed, and say why when there is none."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import msgspec
import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, DOWN, alone, box, cases, random_case, shelf_scene
from engine.messages import Pose
from engine.messages.shapes import Box, Capsule, Obstacle, Solid, Sphere
from robots.io.message_codec import encode_payload, payload_decoder
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform
from robots.planning.planner_names import OMPL_PLANNERS, PLANNERS
from robots.planning.request import (
    JointGoal,
    PathOrientationConstraint,
    PathPlan,
    PlanAnswer,
    PlanRefusal,
    PlanRequest,
    PoseGoal,
)
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import AttachedPart
from robots.planning.worker.planning_messages import FromPlanner, ToPlanner
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import Array
from tests.robots.planning.motion_oracle import MotionOracle
from tests.tiers import nightly

PLANNER = ScenePlanner(check_s=2e-5)
# They take seconds, as RRTstar does.
SLOW = ("RRT", "InformedRRTstar")
CASES = {case.title: case.request for case in cases()}
IRB_BOX, SHELF = CASES["IRB4600, one box"], CASES["Panda, table and shelf"]
HOME = robot_model("panda").home_rad
ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def plan(request: PlanRequest, **changes: object) -> PlanAnswer:
    return PLANNER.plan(msgspec.structs.replace(request, **changes))


def path_of(answer: PlanAnswer) -> Array:
    assert isinstance(answer, PathPlan), answer
    return answer.path


def confirm(request: PlanRequest, answer: PlanAnswer) -> None:
    """MuJoCo finds no contact on the path nor on the motion that follows it, and the ends are those asked for."""
    path = path_of(answer)
    oracle = MotionOracle(request.scene, request.arm, margin_m=request.margin_m)
    assert oracle.first_touch(path) is None
    assert isinstance(answer, PathPlan)
    if answer.timed is not None:
        assert oracle.first_touch(answer.timed.position_rad) is None
    assert path[0].tolist() == list(request.start_rad)
    if isinstance(request.goal, JointGoal):
        assert tuple(path[-1].tolist()) in request.goal.joints_rad


@pytest.mark.parametrize("title", list(CASES))
def test_the_fast_planner_finds_a_confirmed_way_in_every_experiment(title: str) -> None:
    for seed in range(3):
        confirm(CASES[title], plan(CASES[title], seed=seed, speed=1.0))


def test_where_nothing_is_in_the_way_the_way_is_the_straight_line() -> None:
    answer = plan(CASES["IRB4600, free"])
    assert len(path_of(answer)) == 2


@pytest.mark.parametrize("planner", ["stomp", *(nightly(name) if name in SLOW else name for name in OMPL_PLANNERS)])
def test_every_planner_finds_a_confirmed_way_around_a_box(planner: str) -> None:
    confirm(IRB_BOX, plan(IRB_BOX, planner=planner, time_s=30.0))


@pytest.mark.parametrize("planner", ["fast", "stomp", "RRTConnect", "KPIECE1"])
def test_the_same_seed_gives_the_same_way(planner: str) -> None:
    first, second = (path_of(ScenePlanner(check_s=2e-5).plan(_with(IRB_BOX, planner, 5))) for _ in range(2))
    assert np.array_equal(first, second)
    assert not np.array_equal(first, path_of(plan(IRB_BOX, planner=planner, seed=6, time_s=30.0)))


def _with(request: PlanRequest, planner: str, seed: int) -> PlanRequest:
    return msgspec.structs.replace(request, planner=planner, seed=seed, time_s=30.0)


@pytest.mark.parametrize("seed", range(8))
def test_random_shelves_with_clutter_are_solved(seed: int) -> None:
    request = random_case(seed).request
    confirm(request, plan(request, speed=0.5))


def test_a_pose_is_reached_by_whichever_configuration_is_free() -> None:
    goal = Pose(xyz=(0.2, 0.45, 0.3), xyzw=DOWN)
    request = PlanRequest(scene=shelf_scene(), arm=ARM, start_rad=HOME, goal=PoseGoal(pose=goal))
    answer = plan(request)
    path = path_of(answer)
    reached = ArmKinematics(robot_model("panda"), base=ORIGIN).tool_pose(path[-1])
    assert reached.distance_m(RigidTransform.from_pose(goal)) < 1e-4
    assert reached.angle_rad(RigidTransform.from_pose(goal)) < 1e-3
    confirm(request, answer)


def test_the_arm_goes_around_something_rather_than_straight_to_a_far_configuration_of_the_goal() -> None:
    """A pose beyond the box: another turn of an axis would be straight to, three radians away."""
    start = IRB_BOX.start_rad
    goal = IRB_BOX.goal
    assert isinstance(goal, JointGoal)
    near = goal.joints_rad[0]
    far = (near[0], near[1], near[2], near[3], near[4], near[5] + 2.0 * np.pi)
    alone_first = plan(IRB_BOX)
    assert len(path_of(alone_first)) > 2
    both = plan(IRB_BOX, goal=JointGoal(joints_rad=(far, (*start[:5], start[5] + 3.0), near)))
    assert path_of(both)[-1].tolist() == list(near)


def test_a_margin_is_kept_from_obstacles() -> None:
    request = msgspec.structs.replace(IRB_BOX, margin_m=0.1)
    confirm(request, plan(request, speed=1.0))


def test_a_held_rod_makes_the_way_wider() -> None:
    """With a rod of 60 cm the straight line, free for the bare hand, goes through the post."""
    post = Obstacle.of("post", Capsule(radius_m=0.04, length_m=0.5), Pose(xyz=(0.0, 0.65, 0.35)))
    scene = alone("panda").with_obstacles(post)
    turned = (1.57 + 0.9, *HOME[1:])
    start = (1.57 - 0.9, *HOME[1:])
    request = PlanRequest(scene=scene, arm=ARM, start_rad=start, goal=JointGoal(joints_rad=(turned,)))
    assert len(path_of(plan(request))) == 2
    rod = Solid(shape=Box(size_m=(0.6, 0.02, 0.02)), pose=Pose(xyz=(0.0, 0.0, 0.02)))
    held = scene.with_attached(AttachedPart(name="rod", arm=ARM, solids=(rod,)))
    carrying = msgspec.structs.replace(request, scene=held)
    answer = plan(carrying)
    path = path_of(answer)
    assert len(path) > 2
    confirm(carrying, answer)


def test_a_start_next_to_something_is_left_although_the_spheres_are_larger_than_the_arm() -> None:
    """The fingers stand 3 mm above a plate, as before a grasp: no sphere around them is free."""
    x, y, z = ArmKinematics(robot_model("panda"), base=ORIGIN).tool_pose(np.array(HOME)).xyz.tolist()
    far = alone("panda").with_obstacles(box("plate", (0.1, 0.1, 0.02), (x, y, z - 0.1)))
    gap_m = ExactChecker(far, ARM).clearance(np.array(HOME)).distance_m
    scene = far.with_obstacles(box("plate", (0.1, 0.1, 0.02), (x, y, z - 0.1 + gap_m - 0.003)))
    start_gap = ExactChecker(scene, ARM).clearance(np.array(HOME)).distance_m
    assert 0.002 < start_gap < 0.004
    goal = (1.2, *HOME[1:])
    request = PlanRequest(scene=scene, arm=ARM, start_rad=HOME, goal=JointGoal(joints_rad=(goal,)))
    confirm(request, plan(request))


@pytest.mark.parametrize("free_about", [(0.0, 0.0, 1.0), None])
def test_the_tool_keeps_its_orientation_on_the_whole_way(free_about: tuple[float, float, float] | None) -> None:
    scene = alone("panda").with_obstacles(box("wall", (0.1, 0.05, 0.5), (0.45, 0.0, 0.25)))
    ends = [_down_at(0.45, y) for y in (-0.3, 0.3)]
    request = PlanRequest(
        scene=scene,
        arm=ARM,
        start_rad=ends[0],
        goal=JointGoal(joints_rad=(ends[1],)),
        keep_orientation=PathOrientationConstraint(tolerance_rad=0.15, free_about=free_about),
        time_s=20.0,
    )
    answer = plan(request)
    path = path_of(answer)
    confirm(request, answer)
    kinematics = ArmKinematics(robot_model("panda"), base=ORIGIN)
    begin = kinematics.tool_pose(path[0])
    for a, b in pairwise(path):
        for share in np.linspace(0.0, 1.0, 20):
            pose = kinematics.tool_pose(a + share * (b - a))
            if free_about is None:
                assert begin.angle_rad(pose) < 0.16
            else:
                assert float(begin.rotation[:, 2] @ pose.rotation[:, 2]) > np.cos(0.16)


def _down_at(x: float, y: float) -> tuple[float, ...]:
    from robots.model.inverse_kinematics import InverseKinematicsSolver

    inverse = InverseKinematicsSolver(ArmKinematics(robot_model("panda"), base=ORIGIN))
    joints: list[float] = inverse.nearest(RigidTransform.of((x, y, 0.2), DOWN), seed=np.array(HOME)).tolist()
    return tuple(joints)


BLOCK = box("block", (0.3, 0.3, 0.3), (0.31, 0.0, 0.5))


@pytest.mark.parametrize(
    ("changes", "reason", "words"),
    [
        ({"scene": alone("panda").with_obstacles(BLOCK)}, "start_in_collision", "arm/panda_link6 touches block"),
        (
            {"scene": alone("panda").with_obstacles(box("block", (0.3, 0.3, 0.3), (0.0, 0.31, 0.5)))},
            "goal_in_collision",
            "touches block",
        ),
        ({"start_rad": (9.0, *HOME[1:])}, "start_outside_limits", "panda_joint1 at 9.0000 rad"),
        ({"goal": JointGoal(joints_rad=((9.0, *HOME[1:]),))}, "goal_outside_limits", "panda_joint1 at 9.0000 rad"),
        ({"goal": JointGoal(joints_rad=((1.0, 2.0),))}, "goal_outside_limits", "not a configuration of an arm with 7"),
        ({"goal": JointGoal(joints_rad=())}, "goal_outside_limits", "no goal is given"),
        ({"goal": PoseGoal(pose=Pose(xyz=(3.0, 0.0, 0.0)))}, "goal_unreachable", "m"),
        ({"planner": "EST"}, "unknown_planner", "does not provide EST"),
        ({"planner": "stomp", "keep_orientation": PathOrientationConstraint()}, "unknown_planner", "stomp cannot keep"),
        ({"planner": "RRTconnect"}, "unknown_planner", "unknown planner RRTconnect"),
    ],
)
def test_a_plan_that_cannot_be_is_refused_with_the_reason(changes: dict[str, object], reason: str, words: str) -> None:
    request = PlanRequest(
        scene=alone("panda"), arm=ARM, start_rad=HOME, goal=JointGoal(joints_rad=((1.57, *HOME[1:]),))
    )
    answer = plan(request, **changes)
    assert isinstance(answer, PlanRefusal)
    assert answer.reason == reason
    assert words in answer.message
    assert str(answer.error())
    if "no planner" in words or "EST" in words:
        assert all(name in answer.hint for name in PLANNERS)


def _caged() -> PlanRequest:
    """An arm of two joints with a post that its first link cannot pass."""
    model = robot_model("servo_arm")
    x, y, z = ArmKinematics(model, base=ORIGIN).tool_pose(np.array([1.57, 0.0])).xyz.tolist()
    post = Obstacle.of("post", Capsule(radius_m=0.02, length_m=0.5), Pose(xyz=(0.3 * x, 0.3 * y, z)))
    scene = alone("servo_arm").with_obstacles(post)
    return PlanRequest(scene=scene, arm=ARM, start_rad=(0.4, 0.0), goal=JointGoal(joints_rad=((2.7, 0.0),)))


@pytest.mark.parametrize("planner", ["fast", "RRTConnect", "stomp"])
def test_no_path_in_time_is_said_with_what_was_tried(planner: str) -> None:
    answer = plan(_caged(), planner=planner, time_s=0.2)
    assert isinstance(answer, PlanRefusal)
    assert answer.reason == "no_path_in_time"
    assert "configurations checked" in answer.message
    assert f"{planner} found no path within 0.2 s" in answer.message


def test_no_path_quotes_the_margin_and_the_tolerance_that_were_asked_for() -> None:
    """With a smaller one there might be a path."""
    asked = {"margin_m": 0.013, "time_s": 0.1}
    answer = plan(_caged(), **asked)
    assert isinstance(answer, PlanRefusal)
    assert "within 0.1 s with a margin of 13 mm (" in answer.message
    kept = plan(_caged(), keep_orientation=PathOrientationConstraint(tolerance_rad=3.1), **asked)
    assert isinstance(kept, PlanRefusal)
    assert "13 mm, the tool turned by at most 3.1 rad (" in kept.message


def test_a_plan_no_longer_wanted_ends() -> None:
    asked: list[None] = []

    def cancelled() -> bool:
        asked.append(None)
        return len(asked) > 5

    answer = ScenePlanner().plan(msgspec.structs.replace(_caged(), time_s=60.0), cancelled=cancelled)
    assert isinstance(answer, PlanRefusal)
    assert answer.reason == "cancelled"


def test_requests_and_answers_cross_a_process_border_unchanged() -> None:
    request = msgspec.structs.replace(
        SHELF, speed=0.5, keep_orientation=PathOrientationConstraint(), tool=Pose(xyz=(0, 0, 0.1))
    )
    asked: Callable[[bytes], ToPlanner] = payload_decoder(ToPlanner)
    assert asked(encode_payload(request)) == request
    answer = plan(IRB_BOX, speed=1.0)
    answered: Callable[[bytes], FromPlanner] = payload_decoder(FromPlanner)
    received = answered(encode_payload(answer))
    assert isinstance(answer, PathPlan)
    assert isinstance(received, PathPlan)
    assert msgspec.structs.replace(received, timed=None) == msgspec.structs.replace(answer, timed=None)
    assert answer.timed is not None
    assert received.timed is not None
    assert received.timed.dt_s == answer.timed.dt_s
    np.testing.assert_array_equal(received.timed.position_rad, answer.timed.position_rad)
    np.testing.assert_array_equal(received.timed.velocity_rad_s, answer.timed.velocity_rad_s)


def test_a_small_ball_in_the_way_of_the_elbow_is_avoided_too() -> None:
    ball = Obstacle.of("ball", Sphere(radius_m=0.08), Pose(xyz=(0.0, 0.0, 0.0)))
    kinematics = ArmKinematics(robot_model("panda"), base=ORIGIN)
    middle = kinematics.tool_pose(np.array((0.8, *HOME[1:]))).to_pose("world")
    scene = alone("panda").with_obstacles(msgspec.structs.replace(ball, pose=middle))
    request = PlanRequest(scene=scene, arm=ARM, start_rad=HOME, goal=JointGoal(joints_rad=((1.57, *HOME[1:]),)))
    answer = plan(request)
    path = path_of(answer)
    assert len(path) > 2
    confirm(request, answer)
