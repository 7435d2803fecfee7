"""Settings that an arm cannot work with are refused, naming the value and what would be right."""

from __future__ import annotations

import math
from dataclasses import replace as replace_limits

import pytest
from msgspec.structs import replace

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.control.laws.settings_validation import validate_settings
from tests.robots.panda_arm import panda_model

WORKING = ControlSettings(
    controller="cartesian_impedance",
    joint_stiffness_nm_rad=(600.0, 600.0, 600.0, 600.0, 250.0, 150.0, 50.0),
    tool_xyz_m=(0.0, 0.0, 0.1034),
    load_kg=2.0,
    load_com_m=(0.0, 0.0, 0.05),
    collision_torque_nm=(20.0,) * 7,
    collision_force_n=30.0,
    speed_override=0.5,
)


def check(settings: ControlSettings) -> ControlSettings:
    """Check for the Panda."""
    model = panda_model()
    return validate_settings(settings, arm="left", joints=model.arm_joints, limits=model.limits)


@pytest.mark.parametrize("settings", [ControlSettings(), WORKING])
def test_what_the_arm_can_work_with_is_taken(settings: ControlSettings) -> None:
    assert check(settings) == settings


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"joint_stiffness_nm_rad": (600.0,) * 6}, r"joint_stiffness_nm_rad has 6 values \(give one for each of the 7"),
        ({"joint_stiffness_nm_rad": (600.0,) * 6 + (0.0,)}, "panda_joint7 cannot be 0 .more than 0 and at most 600"),
        ({"joint_stiffness_nm_rad": (600.0,) * 6 + (1000.0,)}, "panda_joint7 cannot be 1000"),
        ({"joint_damping_ratio": 0.0}, "joint_damping_ratio cannot be 0"),
        ({"cartesian_damping_ratio": math.nan}, "cartesian_damping_ratio cannot be nan"),
        ({"cartesian_stiffness": (3000.0, -1.0, 3000.0, 200.0, 200.0, 200.0)}, "along y cannot be -1"),
        ({"cartesian_stiffness": (3000.0, 3000.0, 1e5, 200.0, 200.0, 200.0)}, "along z cannot be 100000"),
        ({"cartesian_stiffness": (3000.0, 3000.0, 3000.0, 200.0, 200.0, 2000.0)}, "along rz cannot be 2000"),
        ({"nullspace_stiffness_nm_rad": -1.0}, "nullspace_stiffness_nm_rad cannot be -1"),
        ({"nullspace_stiffness_nm_rad": 5000.0}, "nullspace_stiffness_nm_rad cannot be 5000 .at least 0 and at most "),
        ({"tool_xyz_m": (0.0, 0.0, math.inf)}, "tool_xyz_m cannot be inf"),
        ({"tool_xyzw": (0.0, 0.0, 0.0, 0.5)}, "is not a unit quaternion"),
        ({"tool_xyzw": (0.0, 0.0, 0.0, math.nan)}, "is not a unit quaternion"),
        ({"load_kg": -0.1}, "load_kg cannot be -0.1"),
        ({"load_kg": 50.0}, "load_kg cannot be 50 .at least 0 and at most 8.8"),
        ({"load_com_m": (0.0, 3.0, 0.0)}, "load_com_m cannot be 3"),
        ({"collision_torque_nm": (10.0,)}, "collision_torque_nm has 1 values"),
        ({"collision_torque_nm": (10.0,) * 6 + (-1.0,)}, "collision_torque_nm of panda_joint7 cannot be -1"),
        ({"collision_torque_nm": (10.0,) * 6 + (0.0,)}, r"panda_joint7 cannot be 0 \(more than 0\)$"),
        ({"collision_force_n": 0.0}, r"collision_force_n cannot be 0 \(more than 0\)$"),
        ({"speed_override": 0.0}, "speed_override cannot be 0 .at least 0.001 and at most 1"),
        ({"speed_override": 1.1}, "speed_override cannot be 1.1"),
    ],
)
def test_what_it_cannot_is_refused_in_words(change: dict[str, object], message: str) -> None:
    with pytest.raises(RobotError, match=message) as caught:
        check(replace(WORKING, **change))
    assert caught.value.where == "left"


@pytest.mark.parametrize(
    "change",
    [
        {"nullspace_stiffness_nm_rad": 0.0},
        {"nullspace_stiffness_nm_rad": 100.0},
        {"collision_torque_nm": (0.5,) * 7},
        {"collision_force_n": 0.5},
    ],
)
def test_small_values_are_taken(change: dict[str, object]) -> None:
    settings = replace(WORKING, **change)
    assert check(settings) == settings


def test_an_arm_too_weak_for_the_default_tool_stiffness_takes_settings_that_do_not_use_it() -> None:
    small = replace_limits(panda_model().limits, effort_nm=(1.0,) * 7)
    names = panda_model().arm_joints
    assert validate_settings(ControlSettings(speed_override=0.5), arm="left", joints=names, limits=small)
    with pytest.raises(RobotError, match=r"along x cannot be 3000 \(at least 0 and at most 100"):
        validate_settings(ControlSettings(controller="cartesian_impedance"), arm="left", joints=names, limits=small)
