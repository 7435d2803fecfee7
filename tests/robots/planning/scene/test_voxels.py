"""Spheres meet the voxels that cameras see exactly where cubes are, and so does the exact checker."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from benchmarks.planning_scenes import ARM, alone
from engine.errors import CellError
from engine.messages import Pose, Vector3
from engine.messages.sensing import OccupancyGrid
from engine.messages.shapes import Box, Obstacle, Solid
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene
from robots.planning.scene.voxel_distance_kernels import is_voxel_nearer, voxel_gap
from robots.planning.scene.voxels import Voxels, voxels_of
from robots.planning.search.kernels import blocked_at
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import Array

VOXEL_M = 0.02
PANDA = alone("panda")
PLANNER = ScenePlanner()
BARE = ExactChecker(PANDA, ARM)
LOWER, UPPER = np.array(BARE.model.limits.lower_rad), np.array(BARE.model.limits.upper_rad)


def grid_of(taken: Array, corner_m: Vector3 = (0.0, 0.0, 0.0), voxel_m: float = VOXEL_M) -> OccupancyGrid:
    x, y, z = taken.shape
    bits = np.packbits(taken.astype(np.uint8)).tobytes()
    return OccupancyGrid(time_s=0.0, revision=1, corner_m=corner_m, voxel_m=voxel_m, shape=(x, y, z), occupied=bits)


def scattered(random: np.random.Generator, count: int) -> OccupancyGrid:
    """Return a grid around the arm with so many voxels taken, in clumps."""
    taken = np.zeros((75, 75, 60))
    for _ in range(count):
        x, y, z = (int(random.integers(0, side - 3)) for side in taken.shape)
        dx, dy, dz = random.integers(1, 4, 3).tolist()
        taken[x : x + dx, y : y + dy, z : z + dz] = 1.0
    return grid_of(taken, corner_m=(-0.75, -0.75, -0.03))


def cube_distance(voxels: Voxels, point: Array) -> float:
    """Return the distance of a point from the nearest taken cube by looking at all of them."""
    cubes = np.argwhere(voxels.taken) * voxels.grid[3] + voxels.grid[:3]
    off = np.maximum(np.maximum(cubes - point, point - cubes - voxels.grid[3]), 0.0)
    return float(np.sqrt((off**2).sum(axis=1)).min())


def boxes_of(grid: OccupancyGrid) -> list[Obstacle]:
    """Return an obstacle for each taken voxel."""
    edge = grid.voxel_m
    return [
        Obstacle.of(f"cube_{k}", Box(size_m=(edge, edge, edge)), Pose(xyz=(x, y, z)))
        for k, (x, y, z) in enumerate(((np.argwhere(voxels_of(grid).taken) + 0.5) * edge + grid.corner_m).tolist())
    ]


def blocked(scene: PlanningScene, grid: OccupancyGrid | None, joints: Array, *, margin_m: float = 0.0) -> bool:
    """Return whether the spheres take a configuration for touching something outside."""
    problem = PLANNER.prepared(scene, ARM, occupancy=grid, margin_m=margin_m).problem
    outside = problem._replace(pair_gap=np.full_like(problem.pair_gap, -np.inf))
    return blocked_at(outside, joints[None]) >= 0


@settings(deadline=None)
@given(
    taken=arrays(np.bool_, st.tuples(st.integers(1, 9), st.integers(1, 9), st.integers(1, 17)), elements=st.booleans()),
    centre=st.tuples(*[st.floats(-0.4, 0.8)] * 3),
    radius=st.floats(0.001, 0.3),
    reach=st.floats(-0.05, 0.2),
    corner=st.tuples(*[st.floats(-0.3, 0.3)] * 3),
)
def test_spheres_meet_voxels_exactly_where_the_cubes_are(
    taken: Array, centre: Vector3, radius: float, reach: float, corner: Vector3
) -> None:
    voxels = voxels_of(grid_of(taken, corner_m=corner))
    if not voxels.any:
        return
    balls = np.array([[*centre, radius]])
    distance = cube_distance(voxels, np.array(centre))
    found = is_voxel_nearer(balls, balls, 0, 1, voxels.field, voxels.grid, reach)
    if abs(distance - radius - reach) > 1e-4:
        assert found == (distance - radius < reach and reach + radius > 0.0)
    gap = voxel_gap(balls, balls, 0, 1, voxels.field, voxels.grid, 10.0)
    if distance < 10.5 * VOXEL_M:
        assert gap == pytest.approx(distance - radius, abs=1e-4)
    else:
        assert 8.0 * VOXEL_M < gap + radius <= distance + 1e-4


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000), margin_m=st.sampled_from([0.0, 0.03]))
def test_the_spheres_never_take_for_free_what_touches_voxels_exactly(seed: int, margin_m: float) -> None:
    random = np.random.default_rng(seed)
    grid = scattered(random, 40)
    checker = ExactChecker(PANDA, ARM, margin_m=margin_m).seeing(voxels_of(grid))
    quick = PLANNER.prepared(PANDA, ARM, occupancy=grid, margin_m=margin_m).checker
    for joints in LOWER + random.random((40, 7)) * (UPPER - LOWER):
        touching = [pair for pair in checker.colliding_pairs(joints) if "occupancy" in pair]
        assert not touching or blocked(PANDA, grid, joints, margin_m=margin_m)
        assert quick.colliding_pairs(joints) == checker.colliding_pairs(joints)
        assert (
            quick.in_collision(joints) == checker.in_collision(joints) == (bool(touching) or BARE.in_collision(joints))
        )


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_the_exact_checker_finds_voxels_where_boxes_in_their_places_are_found(seed: int) -> None:
    random = np.random.default_rng(seed)
    grid = scattered(random, 12)
    boxes = PANDA.with_obstacles(*boxes_of(grid))
    seen, solid = PLANNER.prepared(PANDA, ARM, occupancy=grid).checker, ExactChecker(boxes, ARM)
    for joints in LOWER + random.random((15, 7)) * (UPPER - LOWER):
        theirs, ours = solid.clearance(joints), seen.clearance(joints)
        assert (
            ours.distance_m == pytest.approx(theirs.distance_m, abs=1e-3)
            or min(ours.distance_m, theirs.distance_m) < 0.0
        )
        if abs(theirs.distance_m) > 1e-3:
            assert seen.in_collision(joints) == solid.in_collision(joints)


def test_what_a_hand_holds_meets_voxels_too() -> None:
    home = np.array(BARE.model.home_rad)
    grid = grid_of(np.ones((6, 6, 1)), corner_m=(0.25, -0.06, 0.05))
    assert not blocked(PANDA, grid, home)
    rod = Solid(shape=Box(size_m=(0.02, 0.02, 0.8)), pose=Pose(xyz=(0.0, 0.0, 0.4)))
    held = PANDA.with_attached(AttachedPart(name="rod", arm=ARM, solids=(rod,)))
    assert blocked(held, grid, home)
    assert PLANNER.prepared(held, ARM, occupancy=grid).checker.colliding_pairs(home) == (("rod", "occupancy"),)


def test_links_that_may_touch_what_cameras_see_do() -> None:
    home = np.array(BARE.model.home_rad)
    grid = grid_of(np.ones((100, 100, 10)), corner_m=(-1.0, -1.0, 0.4))
    names = {
        name for pair in PLANNER.prepared(PANDA, ARM, occupancy=grid).checker.colliding_pairs(home) for name in pair
    }
    assert "occupancy" in names
    allowed = PANDA.with_allowed(ARM, "occupancy")
    assert not blocked(allowed, grid, home)
    assert not PLANNER.prepared(allowed, ARM, occupancy=grid).checker.in_collision(home)


def test_a_new_grid_leaves_the_prepared_scene_as_it_is() -> None:
    first = PLANNER.prepared(PANDA, ARM, occupancy=grid_of(np.ones((3, 3, 3)), corner_m=(0.3, 0.0, 0.5)))
    second = PLANNER.prepared(PANDA, ARM, occupancy=grid_of(np.ones((2, 2, 2)), corner_m=(0.3, 0.0, 0.5)))
    assert first.problem.spheres is second.problem.spheres
    assert first.checker.checks[0] is second.checker.checks[0]
    assert len(PLANNER.prepared(PANDA, ARM).problem.solids) == 0


def test_where_the_arm_itself_is_makes_no_other_scene() -> None:
    assert PLANNER.prepared(PANDA.with_joints(ARM, [0.1] * 7), ARM) is PLANNER.prepared(PANDA, ARM)


def test_an_empty_grid_is_as_none() -> None:
    assert PLANNER.prepared(PANDA, ARM, occupancy=grid_of(np.zeros((3, 3, 3)))) is PLANNER.prepared(PANDA, ARM)


def test_a_grid_whose_bytes_do_not_fit_its_shape_is_refused() -> None:
    grid = OccupancyGrid(
        time_s=0.0, revision=1, corner_m=(0.0, 0.0, 0.0), voxel_m=0.02, shape=(3, 3, 3), occupied=b"\xff"
    )
    with pytest.raises(CellError, match="1 bytes are not the occupancy"):
        PLANNER.prepared(PANDA, ARM, occupancy=grid)


def test_no_obstacle_may_have_the_name_of_what_cameras_see() -> None:
    with pytest.raises(CellError, match="occupancy is already in the scene"):
        PANDA.with_obstacles(Obstacle.of("occupancy", Box(size_m=(0.1, 0.1, 0.1)), Pose(xyz=(1.0, 0.0, 0.0))))
