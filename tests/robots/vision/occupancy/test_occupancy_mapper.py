"""Tests of the occupancy map with images made for the purpose: what fills, what clears, what stays."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.document.cell_perception import DepthCamera
from engine.errors import CellError
from engine.messages import Pose
from engine.messages.sensing import DepthImage
from engine.messages.shapes import Box, Hull, Obstacle
from robots.port import Array
from robots.vision.camera_rig import CameraRig
from robots.vision.cameras.camera import optical_frame_pose, pinhole
from robots.vision.known_geometry import KnownGeometry, MeasuredState
from robots.vision.occupancy.occupancy_mapper import LONE_IMAGES, MISSES_TO_CLEAR, OccupancyMapper
from tests.robots.vision.watched_cell import BOX, block, cameras, look, perception_setup, scene, voxels

LENS = pinhole((160, 120), 1.0)
DOWN = optical_frame_pose((0.5, 0.0, 2.0), (0.5, 0.0, 0.0))
NOW = MeasuredState(time_s=0.0)
FLOOR_M = 2.0


def image(depth: Array | float = FLOOR_M, **changes: object) -> DepthImage:
    """Return an image of a camera that looks straight down from 2 m."""
    values = np.broadcast_to(np.asarray(depth, dtype=np.float32), (120, 160))
    made = DepthImage(time_s=0.0, camera="down", intrinsics=LENS, pose=DOWN, depth_m=values.tobytes())
    return msgspec.structs.replace(made, **changes)


def over_floor(rows: slice, columns: slice, depth_m: float) -> DepthImage:
    """Return an image of the floor with something over it."""
    depth = np.full((120, 160), FLOOR_M)
    depth[rows, columns] = depth_m
    return image(depth)


def mapper() -> OccupancyMapper:
    """Return a map of a cell with a floor, which is known."""
    made = OccupancyMapper(BOX, ())
    floor = Obstacle.of("floor", Box(size_m=(4.0, 4.0, 0.04)), Pose(xyz=(0.5, 0.0, -0.02)))
    made.know(KnownGeometry(obstacles=(floor,)))
    return made


THING = over_floor(slice(50, 70), slice(70, 90), 1.5)
"""A square at a height of 0.5 m, 0.27 m wide."""


def test_a_thing_is_there_after_one_image_and_where_it_is() -> None:
    found = voxels(mapper().update([THING], NOW))
    assert len(found) > 100
    assert np.abs(found[:, 2] - 0.5).max() <= BOX.voxel_m
    assert found[:, :2].max(axis=0) == pytest.approx((0.5 + 0.135, 0.135), abs=0.03)


def test_the_known_floor_is_left_out() -> None:
    assert len(voxels(mapper().update([image()], NOW))) == 0
    assert len(voxels(OccupancyMapper(BOX, ()).update([image()], NOW))) > 1000


def test_a_thing_that_went_away_is_cleared_after_the_images_that_it_takes() -> None:
    kept = mapper()
    there = voxels(kept.update([THING], NOW))
    for _ in range(MISSES_TO_CLEAR - 1):
        assert len(voxels(kept.update([image()], NOW))) == len(there)
    assert len(voxels(kept.update([image()], NOW))) == 0


def test_what_is_hidden_stays_as_it_was() -> None:
    kept = mapper()
    there = voxels(kept.update([THING], NOW))
    hidden = over_floor(slice(0, 120), slice(0, 160), 0.9)
    for _ in range(4):
        kept.update([hidden], NOW)
    found = voxels(kept.update([hidden], NOW))
    low = found[found[:, 2] < 0.7]
    assert {tuple(p) for p in low.round(3).tolist()} == {tuple(p) for p in there.round(3).tolist()}


@pytest.mark.parametrize("value", [0.0, math.nan, -math.inf, -1.0, 1e30])
def test_garbage_neither_fills_nor_clears(value: float) -> None:
    kept = mapper()
    assert len(voxels(kept.update([image(value)], NOW))) == 0
    there = kept.update([THING], NOW)
    for _ in range(4):
        kept.update([image(value)], NOW)
    after = kept.update([image(value)], NOW)
    assert after.occupied == there.occupied
    assert after.revision == there.revision


def test_nothing_as_far_as_the_camera_sees_fills_nothing_and_clears() -> None:
    kept = mapper()
    assert len(voxels(kept.update([image(math.inf)], NOW))) == 0
    kept.update([THING], NOW)
    for _ in range(MISSES_TO_CLEAR):
        kept.update([image(math.inf)], NOW)
    assert len(voxels(kept.update([image(math.inf)], NOW))) == 0


def test_a_single_voxel_of_noise_is_no_obstacle() -> None:
    kept = mapper()
    random = np.random.default_rng(0)
    for _ in range(30):
        depth = np.full((120, 160), FLOOR_M)
        row, column = random.integers(20, 100), random.integers(40, 120)
        depth[row, column] = random.uniform(1.2, 1.8)
        assert len(voxels(kept.update([image(depth)], NOW))) == 0


def test_a_small_thing_that_stays_is_an_obstacle_all_the_same() -> None:
    kept = mapper()
    small = over_floor(slice(60, 61), slice(80, 81), 1.55)
    counts = [len(voxels(kept.update([small], NOW))) for _ in range(LONE_IMAGES)]
    assert counts == [0] * (LONE_IMAGES - 1) + [1]


def test_a_noisy_still_scene_does_not_flicker() -> None:
    kept = mapper()
    random = np.random.default_rng(1)
    depth = np.full((120, 160), FLOOR_M)
    depth[50:70, 70:90] = 1.5
    grids = [kept.update([image(depth + random.normal(0.0, 0.002, depth.shape) * depth**2)], NOW) for _ in range(40)]
    counts = [len(voxels(grid)) for grid in grids]
    revisions = [grid.revision for grid in grids]
    assert min(counts) > 100
    # Evidence gathers at first; then hardly anything changes, and nothing comes and goes with each image.
    assert revisions[-1] - revisions[19] <= 5
    assert abs(counts[-1] - counts[19]) <= 5


def test_the_revision_rises_only_with_a_change() -> None:
    kept = mapper()
    revisions = [kept.update([seen], NOW).revision for seen in (image(), THING, THING, image(), image(), image())]
    assert revisions == [1, 2, 2, 2, 3, 3]


def test_one_camera_fills_what_the_other_does_not_see_and_neither_clears_what_the_other_hits() -> None:
    what = scene(block((0.4, 0.0, 0.3), (0.2, 0.2, 0.2)))
    seen_by = cameras(
        front=DepthCamera(at=(2.0, 0.0, 1.2), look_at=(0.4, 0.0, 0.3)),
        back=DepthCamera(at=(-1.2, 0.0, 1.2), look_at=(0.4, 0.0, 0.3)),
    )
    told = KnownGeometry(obstacles=(Obstacle.of("floor", Box(size_m=(4.0, 4.0, 0.04)), Pose(xyz=(0.0, 0.0, -0.02))),))
    faces: dict[tuple[str, ...], tuple[bool, bool]] = {}
    for names in (("front",), ("back",), ("front", "back")):
        eye = CameraRig(perception_setup(what, *seen_by), repeatable=True)
        eye.know(told)
        grids = [eye.look(look(what, names)).grid for _ in range(4)]
        assert len({grid.occupied for grid in grids[2:] if grid is not None}) == 1
        side = voxels(grids[-1])
        low = side[side[:, 2] < 0.35]
        faces[names] = (bool((low[:, 0] > 0.46).any()), bool((low[:, 0] < 0.34).any()))
    assert faces == {("front",): (True, False), ("back",): (False, True), ("front", "back"): (True, True)}


def test_a_forgotten_map_is_empty_and_its_revision_goes_on_rising() -> None:
    kept = mapper()
    before = kept.update([THING], NOW)
    kept.forget()
    after = kept.update([image(0.0)], NOW)
    assert len(voxels(after)) == 0
    assert after.revision == before.revision + 1


def test_a_known_thing_is_taken_out_at_once_and_what_was_in_it_is_forgotten() -> None:
    kept = mapper()
    kept.update([THING], NOW)
    floor = Obstacle.of("floor", Box(size_m=(4.0, 4.0, 0.04)), Pose(xyz=(0.5, 0.0, -0.02)))
    shelf = Obstacle.of("shelf", Box(size_m=(0.4, 0.4, 0.06)), Pose(xyz=(0.5, 0.0, 0.49)))
    kept.know(KnownGeometry(obstacles=(floor, shelf)))
    assert len(voxels(kept.update([THING], NOW))) == 0
    kept.know(KnownGeometry(obstacles=(floor,)))
    assert len(voxels(kept.update([image(0.0)], NOW))) == 0


@settings(max_examples=40)
@given(st.integers(0, 2**31))
def test_no_voxel_is_filled_where_nothing_was_measured(seed: int) -> None:
    random = np.random.default_rng(seed)
    depth = random.choice([0.0, math.nan, 1.2, 1.4, 1.7, FLOOR_M], size=(12, 16)).repeat(10, axis=0).repeat(10, axis=1)
    found = voxels(OccupancyMapper(BOX, ()).update([image(depth)], NOW))
    known = {round(2.0 - d, 3) for d in (1.2, 1.4, 1.7, FLOOR_M)}
    for height in np.unique(found[:, 2]):
        assert min(abs(height - k) for k in known) <= BOX.voxel_m / 2.0 + 1e-6


@pytest.mark.parametrize(
    "thing",
    [
        Obstacle.of("thing", Box(size_m=(0.1, -0.1, 0.1)), Pose(xyz=(0.5, 0.0, 0.5))),
        Obstacle.of("thing", Box(size_m=(0.1, 0.1, 0.1)), Pose(xyz=(math.nan, 0.0, 0.5))),
        Obstacle.of("thing", Hull(points_m=((0.0, 0.0, 0.0),) * 4), Pose(xyz=(0.5, 0.0, 0.5))),
    ],
)
def test_a_known_thing_that_is_none_is_refused_by_its_name(thing: Obstacle) -> None:
    kept = mapper()
    before = kept.update([THING], NOW)
    floor = Obstacle.of("floor", Box(size_m=(4.0, 4.0, 0.04)), Pose(xyz=(0.5, 0.0, -0.02)))
    kept.know(KnownGeometry(obstacles=(floor, thing)))
    with pytest.raises(CellError, match=r"^thing: "):
        kept.update([THING], NOW)
    kept.know(KnownGeometry(obstacles=(floor,)))
    assert kept.update([THING], NOW) == before


def test_images_and_postures_that_are_none_are_refused_and_leave_the_map_as_it_was() -> None:
    kept = mapper()
    before = kept.update([THING], NOW)
    flat = msgspec.structs.replace(LENS, fx_px=0.0)
    for bad in (
        image(depth_m=b"12"),
        image(intrinsics=flat),
        image(intrinsics=msgspec.structs.replace(LENS, cx_px=math.nan)),
        image(pose=Pose(xyz=(math.nan, 0.0, 0.0))),
        image(pose=Pose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, 0.0, 0.0))),
    ):
        with pytest.raises(CellError):
            kept.update([bad], NOW)
    assert kept.update([THING], NOW) == before
