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
FRAMES = ToolFrames(arm="right", base_link="panda_link0", base=TURNED)


def test_a_pose_in_the_base_frame_is_placed_in_the_world() -> None:
    """The right arm looks back along x."""
    world = FRAMES.to_world(Pose(xyz=(0.3, 0.1, 0.2), frame="right/panda_link0"))
    assert np.allclose(world.xyz, [0.25, -0.1, 0.2])
    assert np.allclose(np.abs(world.xyzw), [0.0, 0.0, 1.0, 0.0])


def test_a_pose_in_the_world_stays_as_it_is() -> None:
    """No conversion."""
    assert FRAMES.to_world(Pose(xyz=(0.3, 0.1, 0.2))).to_pose("world") == Pose(xyz=(0.3, 0.1, 0.2))


def test_an_unknown_frame_is_refused_by_name() -> None:
    """And the known ones are named."""
    with pytest.raises(RobotError, match=r"'tray' is not known .*'world' or 'right/panda_link0'"):
        FRAMES.to_world(Pose(xyz=(0.0, 0.0, 0.0), frame="tray"))


def test_numbers_that_are_no_pose_are_refused() -> None:
    """Not a number, or no orientation."""
    for bad in (Pose(xyz=(math.nan, 0.0, 0.0)), Pose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, 0.0, 0.0))):
        with pytest.raises(RobotError, match="is not a pose"):
            FRAMES.to_world(bad)
