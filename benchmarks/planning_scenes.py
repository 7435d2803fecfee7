"""The scenes that planners are measured and tested in: the documents' experiments, a Panda's shelf, random ones."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from engine.errors import RobotError
from engine.messages import Pose
from engine.messages.shapes import Box, Cylinder, Obstacle, Sphere
from robots.model.inverse_kinematics import InverseKinematicsSolver
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.planning.request import JointGoal, PlanRequest
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import PlanningScene, SceneArm
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement

ARM = "arm"
DOWN = (1.0, 0.0, 0.0, 0.0)
FORWARD = (0.0, 0.7071067811865476, 0.0, 0.7071067811865476)


@dataclass(frozen=True, kw_only=True)
class Case:
    """A request that planners are compared on; its planner and seed are set for each run."""

    title: str
    request: PlanRequest


def box(name: str, size_m: tuple[float, float, float], xyz: tuple[float, float, float]) -> Obstacle:
    """Return a box along the world's axes."""
    return Obstacle.of(name, Box(size_m=size_m), Pose(xyz=xyz))


def alone(model: str, *, gripper: str | None = "own") -> PlanningScene:
    """Return the scene of one arm at the origin."""
    placement = ArmPlacement(name=ARM, model=model, base=Pose(xyz=(0.0, 0.0, 0.0)), gripper=gripper)
    return PlanningScene(arms=(SceneArm(placement=placement),))


def shelf_scene(*, depth_m: float = 0.65, boards_m: tuple[float, ...] = (0.2, 0.5, 0.8)) -> PlanningScene:
    """Return a Panda on a table in front of a shelf that is open towards it."""
    boards = [box(f"board_{i}", (0.3, 0.9, 0.02), (depth_m, 0.0, z)) for i, z in enumerate(boards_m)]
    middle, height = (boards_m[0] + boards_m[-1]) / 2, boards_m[-1] - boards_m[0] + 0.1
    scene = alone("panda").with_obstacles(
        box("table", (1.6, 1.6, 0.04), (0.4, 0.0, -0.03)),
        *boards,
        box("side_left", (0.3, 0.02, height), (depth_m, 0.45, middle)),
        box("side_right", (0.3, 0.02, height), (depth_m, -0.45, middle)),
        box("back", (0.02, 0.9, height), (depth_m + 0.16, 0.0, middle)),
    )
    # The arm is bolted to the table, which the shape of its first link reaches into.
    return scene.with_allowed(f"{ARM}/panda_link1", "table")


def cases() -> tuple[Case, ...]:
    """Return the documents' experiments and the Panda's shelf."""
    irb, ur10 = alone("irb4600"), alone("ur10")
    irb_box = irb.with_obstacles(box("box", (0.4, 0.4, 0.8), (1.3, 0.0, 1.2)))
    ur10_box = ur10.with_obstacles(box("box", (0.3, 0.3, 0.6), (0.7, 0.0, 0.4)))
    irb_ends = ((-0.7, 0.3, 0.2, 0.0, 0.5, 0.0), (0.7, 0.3, 0.2, 0.0, 0.5, 0.0))
    ur10_ends = ((-0.9, -0.9, 1.6, -0.7, 0.0, 0.0), (0.9, -0.9, 1.6, -0.7, 0.0, 0.0))
    shelf = shelf_scene()
    inside, other = _tool_at(shelf, (0.58, 0.1, 0.35), FORWARD), _tool_at(shelf, (0.58, -0.15, 0.65), FORWARD)
    return (
        _case("IRB4600, free", irb, *irb_ends),
        _case("IRB4600, one box", irb_box, *irb_ends),
        _case("UR10 start–wait, free", ur10, *ur10_ends),
        _case("UR10, one box", ur10_box, *ur10_ends),
        _case("Panda, table and shelf", shelf, inside, other),
    )


def random_case(seed: int) -> Case:
    """Return a Panda before a shelf of random place with clutter on the table; random free ends, half in the shelf."""
    random = np.random.default_rng(seed)
    low = float(random.uniform(0.12, 0.3))
    gap = float(random.uniform(0.28, 0.36))
    depth_m = float(random.uniform(0.62, 0.75))
    scene = shelf_scene(depth_m=depth_m, boards_m=(low, low + gap, low + 2 * gap))
    for i in range(int(random.integers(3, 8))):
        scene = scene.with_obstacles(_clutter(random, f"thing_{i}"))
    checker = ExactChecker(scene, ARM)
    first = _free_end(random, scene, checker, depth_m=depth_m, floor_m=low, gap_m=gap, in_shelf=True)
    second = _free_end(
        random, scene, checker, depth_m=depth_m, floor_m=low, gap_m=gap, in_shelf=bool(random.random() < 0.5)
    )
    ends = (first, second) if random.random() < 0.5 else (second, first)
    return _case(f"random {seed}", scene, *ends)


def _clutter(random: np.random.Generator, name: str) -> Obstacle:
    radius, length = float(random.uniform(0.03, 0.07)), float(random.uniform(0.08, 0.3))
    turn, reach = float(random.uniform(-2.8, 2.8)), float(random.uniform(0.3, 0.55))
    at = Pose(xyz=(reach * float(np.cos(turn)), reach * float(np.sin(turn)), length / 2))
    kind = int(random.integers(3))
    if kind == 0:
        return Obstacle.of(name, Cylinder(radius_m=radius, length_m=length), at)
    if kind == 1:
        return Obstacle.of(name, Box(size_m=(2 * radius, 2 * radius, length)), at)
    return Obstacle.of(name, Sphere(radius_m=radius), at)


def _free_end(
    random: np.random.Generator,
    scene: PlanningScene,
    checker: ExactChecker,
    *,
    depth_m: float,
    floor_m: float,
    gap_m: float,
    in_shelf: bool,
) -> Array:
    """Return a free configuration with the tool in a compartment of the shelf, or above the table."""
    inverse = _inverse()
    for _ in range(200):
        if in_shelf:
            height = floor_m + gap_m * (0.5 + float(random.integers(2))) + float(random.uniform(-0.04, 0.04))
            across = float(random.uniform(-0.3, 0.3))
            goal = RigidTransform.of((depth_m - float(random.uniform(0.0, 0.12)), across, height), FORWARD)
        else:
            turn, reach = float(random.uniform(-2.0, 2.0)), float(random.uniform(0.35, 0.6))
            place = (reach * float(np.cos(turn)), reach * float(np.sin(turn)), float(random.uniform(0.08, 0.4)))
            goal = RigidTransform.of(place, DOWN)
        try:
            found = inverse.all_solutions(goal).joints
        except RobotError:
            continue
        free = [joints for joints in found[:20] if not checker.in_collision(joints)]
        if free:
            return free[int(random.integers(len(free)))]
    return np.array(checker.model.home_rad)


@lru_cache(maxsize=1)
def _inverse() -> InverseKinematicsSolver:
    model = alone("panda").arms[0].placement.robot()
    return InverseKinematicsSolver(ArmKinematics(model, base=RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))))


def _tool_at(scene: PlanningScene, xyz: tuple[float, float, float], xyzw: tuple[float, float, float, float]) -> Array:
    checker = ExactChecker(scene, ARM)
    found = _inverse().all_solutions(RigidTransform.of(xyz, xyzw)).joints
    return next(joints for joints in found if not checker.in_collision(joints))


def _case(title: str, scene: PlanningScene, start: Array | tuple[float, ...], goal: Array | tuple[float, ...]) -> Case:
    request = PlanRequest(
        scene=scene,
        arm=ARM,
        start_rad=tuple(float(q) for q in start),
        goal=JointGoal(joints_rad=(tuple(float(q) for q in goal),)),
    )
    return Case(title=title, request=request)
