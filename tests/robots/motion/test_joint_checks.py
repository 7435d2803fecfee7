"""What an arm's joints cannot do is refused with joint, time and amount; what they just can do passes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.errors import RobotError
from robots.model.joint_map import JointMap
from robots.motion.joint_checks import check_device_range, check_speed
from robots.port import JointTrajectory
from tests.robots.panda_arm import panda_model

NAMES = ("shoulder", "elbow")
COUPLED = JointMap(matrix=((1.0, 0.0), (1.0, 1.0)), offset_rad=(0.0, 0.1), lower_rad=(-9.0, -1.0), upper_rad=(9.0, 1.2))
"""The controller measures the elbow against the horizontal; its range is narrower than that of the joint."""


def line(*rows: tuple[float, float], dt_s: float = 0.5) -> JointTrajectory:
    """Joints at even times, at rest at each."""
    joints = np.array(rows)
    return JointTrajectory(dt_s=dt_s, position_rad=joints, velocity_rad_s=np.zeros_like(joints))


@pytest.mark.parametrize("rows", [((0.0, 0.0), (0.5, 0.6)), ((0.0, 0.0), (-0.5, -0.6)), ((0.5, 0.9), (0.5, 0.7))])
def test_angles_of_the_controller_within_its_range_pass(rows: tuple[tuple[float, float], ...]) -> None:
    """Up to the range itself; and from beyond it back."""
    check_device_range(COUPLED, NAMES, line(*rows))


@pytest.mark.parametrize(
    ("rows", "angle"),
    [
        (((0.0, 0.0), (0.6, 0.6), (0.0, 0.0)), "1.300"),
        (((0.0, 0.0), (-0.6, -0.6), (0.0, 0.0)), "-1.100"),
        (((0.5, 0.9), (0.5, 1.0), (0.0, 0.0)), "1.600"),
    ],
)
def test_an_angle_of_the_controller_beyond_its_range_is_refused(
    rows: tuple[tuple[float, float], ...], angle: str
) -> None:
    """Also one that was beyond it at the start and goes further out."""
    with pytest.raises(RobotError) as refusal:
        check_device_range(COUPLED, NAMES, line(*rows))
    assert str(refusal.value) == (
        "the controller's angle of elbow (elbow + shoulder) would leave its range at t=0.50 s:"
        f" {angle} rad, range -1.0 to 1.2 rad"
        " (the axes are coupled, see `<arm>/device_joints`; choose another configuration)"
    )


def test_the_speed_between_two_samples_is_known_exactly() -> None:
    """From rest to rest in one interval: the spline is one and a half times as fast in its middle as on average."""
    limits = replace(panda_model().limits, velocity_rad_s=(1.5, 9.0), acceleration_rad_s2=(99.0, 99.0))
    check_speed(limits, NAMES, line((0.0, 0.0), (1.0, 0.0), dt_s=1.0))
    with pytest.raises(RobotError) as refusal:
        check_speed(limits, NAMES, line((0.0, 0.0), (1.96, 0.0), dt_s=1.0))
    assert (
        str(refusal.value)
        == "shoulder would need 2.9 rad/s at t=0.00 s, limit 1.5, to arrive after 1 s (allow at least 2.0 s)"
    )
