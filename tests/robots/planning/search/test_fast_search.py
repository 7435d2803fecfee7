"""The compiled checks: never free where an obstacle is touched, edges as their points, room and lessons taken."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, alone, box, shelf_scene
from engine.messages import Pose
from engine.messages.shapes import Capsule, Cylinder, Hull, Obstacle, Solid, Sphere
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker, PathCollision
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene, SceneArm
from robots.planning.search.fast_search import shorten_path, with_room_for, with_wider_gaps
from robots.planning.search.kernels import blocked_at, gaps, tool_rotation
from robots.planning.search.problem_compiler import compile_problem
from robots.planning.search.search_task import SearchBudget
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement

CORNERS = ((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.3), (0.2, 0.2, 0.1))
ROD = Solid(shape=Cylinder(radius_m=0.02, length_m=0.2), pose=Pose(xyz=(0.0, 0.0, 0.1)))
TURNED = (0.5, 0.1, -0.3, 0.8062)


def every_shape() -> PlanningScene:
    """A Panda among one obstacle of each shape, tilted, with a rod in its hand."""
    return (
        alone("panda")
        .with_obstacles(
            box("box", (0.2, 0.3, 0.1), (0.5, 0.2, 0.3)),
            Obstacle.of("cylinder", Cylinder(radius_m=0.1, length_m=0.4), Pose(xyz=(0.3, -0.4, 0.4), xyzw=TURNED)),
            Obstacle.of("ball", Sphere(radius_m=0.15), Pose(xyz=(-0.4, 0.3, 0.6))),
            Obstacle.of("pill", Capsule(radius_m=0.08, length_m=0.4), Pose(xyz=(0.0, 0.5, 0.5), xyzw=TURNED)),
            Obstacle.of("hull", Hull(points_m=CORNERS), Pose(xyz=(-0.5, -0.3, 0.2), xyzw=TURNED)),
        )
        .with_attached(AttachedPart(name="rod", arm=ARM, solids=(ROD,)))
    )


def random_joints(checker: ExactChecker, count: int, seed: int = 0) -> Array:
    limits = checker.model.limits
    share = np.random.default_rng(seed).random((count, checker.dof))
    return np.array(limits.lower_rad) + share * (np.array(limits.upper_rad) - np.array(limits.lower_rad))


def blocked(problem: CompiledProblem, joints: Array) -> bool:
    return blocked_at(problem, np.ascontiguousarray(joints)[None]) >= 0


def test_no_configuration_that_touches_an_obstacle_is_taken_for_free() -> None:
    scene = every_shape()
    checker = ExactChecker(scene, ARM)
    problem, _ = compile_problem(scene, ARM)
    touched: set[str] = set()
    free = 0
    for joints in random_joints(checker, 1500):
        outside = {name for pair in checker.colliding_pairs(joints) for name in pair} & {
            o.name for o in scene.obstacles
        }
        if outside:
            touched |= outside
            assert blocked(problem, joints), outside
        else:
            free += not blocked(problem, joints)
    assert free > 200
    assert touched == {obstacle.name for obstacle in scene.obstacles}


def test_distances_of_the_spheres_are_never_more_than_the_true_ones() -> None:
    scene = every_shape()
    checker = ExactChecker(scene, ARM)
    problem, names = compile_problem(scene, ARM)
    to_solids, between = np.empty_like(problem.solid_gap), np.empty_like(problem.pair_gap)
    for joints in random_joints(checker, 60, seed=1):
        gaps(problem, joints, to_solids, between)
        true = checker.clearance(joints)
        links, solids = set(names.links), set(names.solids)
        if true.distance_m > 0.0 and set(true.pair) & solids and set(true.pair) & links:
            assert float(to_solids[problem.link_joint > 0].min()) <= true.distance_m + 1e-6


def test_an_edge_is_blocked_where_one_of_its_points_is() -> None:
    scene = every_shape()
    checker = ExactChecker(scene, ARM)
    problem, _ = compile_problem(scene, ARM)
    found = {True: 0, False: 0}
    starts = [q for q in random_joints(checker, 400, seed=2) if not blocked(problem, q)]
    for a, b in pairwise(starts):
        end = a + 0.3 * (b - a)
        count = max(1, math.ceil(float(np.abs(end - a) @ problem.bound) / problem.step_m))
        points = [a + (end - a) * (i / count) for i in range(1, count + 1)]
        expected = any(blocked(problem, point) for point in points)
        assert (blocked_at(problem, np.vstack((a, end))) == 1) == expected
        found[expected] += 1
    assert min(found.values()) > 20


def test_what_is_known_to_be_free_gets_room_and_stays_free_after_a_lesson() -> None:
    scene = shelf_scene()
    checker = ExactChecker(scene, ARM)
    problem, names = compile_problem(scene, ARM)
    unsure = [q for q in random_joints(checker, 3000, seed=3) if blocked(problem, q) and not checker.in_collision(q)]
    assert len(unsure) > 20
    joints = unsure[0]
    roomy = with_room_for(problem, joints[None])
    assert not blocked(roomy, joints)
    assert (roomy.solid_gap <= problem.solid_gap).all()
    # The exact check refuses a configuration that the spheres take for free: they learn, and only of that pair.
    touching = next(
        q for q in random_joints(checker, 6000, seed=4) if checker.in_collision(q) and not blocked(problem, q)
    )
    hit = PathCollision(segment=0, share=0.0, joints=touching, pairs=checker.colliding_pairs(touching))
    wiser = with_wider_gaps(roomy, names, hit)
    assert blocked(wiser, touching)
    assert not blocked(with_room_for(wiser, joints[None]), joints)
    changed: list[set[str]] = [
        {names.links[int(a)], names.links[int(b)]}
        for (a, b), old, new in zip(problem.pairs, roomy.pair_gap, wiser.pair_gap, strict=True)
        if old != new
    ]
    assert all(pair in [set(found) for found in hit.pairs] for pair in changed)


def test_a_shortened_way_is_free_shorter_and_has_the_same_ends() -> None:
    problem, _ = compile_problem(alone("panda"), ARM)
    home = np.array(alone("panda").arms[0].placement.robot().home_rad)
    random = np.random.default_rng(5)
    way = home + np.vstack((np.zeros(7), random.normal(size=(6, 7)) * 0.3, np.full(7, 0.2)))
    assert blocked_at(problem, way) < 0
    shorter = shorten_path(problem, way, seed=1, budget=SearchBudget(1.0))
    assert np.array_equal(shorter[[0, -1]], way[[0, -1]])
    assert blocked_at(problem, shorter) < 0
    assert _length(shorter) == pytest.approx(float(np.linalg.norm(way[-1] - way[0])), rel=0.05)


def _length(path: Array) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def test_the_core_knows_where_the_tool_points_at_any_base() -> None:
    base = Pose(xyz=(0.3, -0.2, 0.5), xyzw=TURNED)
    placement = ArmPlacement(name=ARM, model="ur10", base=base, gripper="robotiq_2f85")
    scene = PlanningScene(arms=(SceneArm(placement=placement),))
    problem, _ = compile_problem(scene, ARM)
    kinematics = ArmKinematics(placement.robot(), base=RigidTransform.from_pose(base))
    for joints in np.random.default_rng(6).uniform(-3.0, 3.0, (20, 6)):
        assert np.allclose(tool_rotation(problem, joints), kinematics.tool_pose(joints).rotation, atol=1e-9)
