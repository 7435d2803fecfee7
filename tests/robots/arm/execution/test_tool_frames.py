"""The frames of an arm."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine.errors import RobotError
from engine.messages import Pose
from robots.arm import ToolFrames
from robots.model.transform import RigidTransform

TURNED = RigidTransform.of((0.55, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
TRAY = Pose(xyz=(0.1, 0.2, 0.3), xyzw=(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
FRAMES = ToolFrames(arm="right", base_link="panda_link0", base=TURNED, named={"tray": TRAY})


def test_a_pose_in_the_base_frame_is_placed_in_the_world() -> None:
    """The right arm looks back along x."""
    world = FRAMES.to_world(Pose(xyz=(0.3, 0.1, 0.2), frame="right/panda_link0"))
    assert np.allclose(world.xyz, [0.25, -0.1, 0.2])
    assert np.allclose(np.abs(world.xyzw), [0.0, 0.0, 1.0, 0.0])


def test_a_pose_in_the_world_stays_as_it_is() -> None:
    """No conversion."""
    assert FRAMES.to_world(Pose(xyz=(0.3, 0.1, 0.2))).to_pose("world") == Pose(xyz=(0.3, 0.1, 0.2))


def test_a_pose_in_a_named_frame_is_placed_in_the_world() -> None:
    """The tray is turned by 90° about z."""
    world = FRAMES.to_world(Pose(xyz=(0.05, 0.0, 0.01), frame="tray"))
    assert np.allclose(world.xyz, [0.1, 0.25, 0.31])
    assert np.allclose(world.xyzw, TRAY.xyzw)


def test_an_unknown_frame_is_refused_by_name() -> None:
    """And the known ones are named, or the closest."""
    with pytest.raises(RobotError, match=r"'moon' is not known .*known: right/panda_link0, tray, world"):
        FRAMES.to_world(Pose(xyz=(0.0, 0.0, 0.0), frame="moon"))
    with pytest.raises(RobotError, match=r"'trai' is not known .*did you mean tray\?"):
        FRAMES.to_world(Pose(xyz=(0.0, 0.0, 0.0), frame="trai"))


def test_numbers_that_are_no_pose_are_refused() -> None:
    """Not a number, or no orientation."""
    for bad in (Pose(xyz=(math.nan, 0.0, 0.0)), Pose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, 0.0, 0.0))):
        with pytest.raises(RobotError, match="is not a pose"):
            FRAMES.to_world(bad)
