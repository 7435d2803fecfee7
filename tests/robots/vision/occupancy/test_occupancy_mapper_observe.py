"""Space is free only where a camera has looked through it lately, and known where something known is."""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from engine.messages import Pose
from engine.messages.sensing import LONG_UNSEEN, NEVER_SEEN, DepthImage, ObservedSpace
from engine.messages.shapes import Box, Obstacle
from robots.planning.unknown_voxels import unknown_voxels
from robots.vision.cameras.camera import optical_frame_pose, pinhole
from robots.vision.known_geometry import KnownGeometry, MeasuredState
from robots.vision.occupancy.occupancy_mapper import OccupancyMapper
from tests.robots.vision.watched_cell import BOX

LENS = pinhole((160, 120), 1.0)
DOWN = optical_frame_pose((0.5, 0.0, 2.0), (0.5, 0.0, 0.0))


def image(time_s: float, depth_m: float = 2.0) -> DepthImage:
    """Return an image of a camera that looks straight down from 2 m."""
    values = np.full((120, 160), depth_m, dtype=np.float32)
    return DepthImage(time_s=time_s, camera="down", intrinsics=LENS, pose=DOWN, depth_m=values.tobytes())


def mapper(*, far_m: float = math.inf) -> OccupancyMapper:
    """Return a map of a cell with a known block."""
    made = OccupancyMapper(BOX, (), far_m={"down": far_m})
    block = Obstacle.of("block", Box(size_m=(0.2, 0.2, 0.2)), Pose(xyz=(0.5, 0.0, 0.4)))
    made.know(KnownGeometry(obstacles=(block,)))
    return made


def observed(made: OccupancyMapper, at_s: float, *images: DepthImage) -> ObservedSpace:
    """Return what is observed after these images."""
    made.update(images, MeasuredState(time_s=at_s))
    return made.observe(images, time_s=at_s)


def ages(space: ObservedSpace) -> NDArray[np.uint8]:
    """Return the ages by voxel."""
    return np.frombuffer(space.ages, dtype=np.uint8).reshape(space.shape)


def at(space: ObservedSpace, x: float, y: float, z: float) -> int:
    """Return the age of the voxel at a point."""
    i, j, k = ((np.array((x, y, z)) - space.corner_m) / space.voxel_m).astype(int).tolist()
    return int(ages(space)[i, j, k])


def test_before_the_first_image_nothing_but_known_bodies_is_known() -> None:
    space = observed(mapper(), 0.0)
    assert at(space, 0.5, 0.0, 0.4) == 0
    assert at(space, 0.2, 0.3, 0.6) == NEVER_SEEN
    assert unknown_voxels(space).mean() > 0.95


def test_space_before_a_surface_is_seen_and_space_behind_it_is_not() -> None:
    space = observed(mapper(), 0.0, image(0.0, 1.3))
    assert (at(space, 0.2, 0.1, 0.8), at(space, 0.2, 0.1, 0.7)) == (0, 0)
    assert at(space, 0.2, 0.1, 0.6) == NEVER_SEEN


def test_pixels_without_a_measurement_show_nothing_and_those_beyond_the_range_all_of_it() -> None:
    assert at(observed(mapper(), 0.0, image(0.0, 0.0)), 0.2, 0.1, 0.8) == NEVER_SEEN
    assert at(observed(mapper(), 0.0, image(0.0, math.inf)), 0.2, 0.1, 0.1) == 0
    far = observed(mapper(far_m=1.5), 0.0, image(0.0, math.inf))
    assert (at(far, 0.2, 0.1, 0.6), at(far, 0.2, 0.1, 0.4)) == (0, NEVER_SEEN)


def test_the_age_grows_until_it_no_longer_fits_and_space_is_unknown_after_the_limit() -> None:
    made = mapper()
    observed(made, 0.0, image(0.0))
    later = [observed(made, at_s) for at_s in (1.0, 5.0, 5.2, 100.0)]
    assert [at(space, 0.2, 0.1, 0.8) for space in later] == [10, 50, 52, LONG_UNSEEN]
    seen = at(later[0], 0.2, 0.1, 0.8) == 10
    assert seen
    unknown = [bool(unknown_voxels(space)[ages(later[0]) == 10].all()) for space in later]
    assert unknown == [False, False, True, True]


def test_an_image_that_comes_late_counts_from_its_own_time() -> None:
    made = mapper()
    observed(made, 2.0, image(2.0))
    assert at(observed(made, 3.0, image(1.0)), 0.2, 0.1, 0.8) == 10


def test_forgetting_makes_all_space_unknown() -> None:
    made = mapper()
    observed(made, 0.0, image(0.0))
    made.forget()
    assert at(observed(made, 0.1), 0.2, 0.1, 0.8) == NEVER_SEEN


def test_the_limit_is_that_of_the_cell() -> None:
    made = OccupancyMapper(msgspec.structs.replace(BOX, seen_within_s=1.0), ())
    observed(made, 0.0, image(0.0))
    assert bool(unknown_voxels(observed(made, 1.2))[5, 35, 40])
