"""The master plate of a tool changer in the model of an arm: its mass, its place, and what it may touch."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from engine.document import ToolChangerSpec
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform

AT_ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


@pytest.mark.parametrize("arm", ["panda", "ur10", "irb4600"])
def test_the_tool_centre_point_is_in_the_face_in_front_of_the_flange(arm: str) -> None:
    bare = robot_model(arm, gripper=None)
    with_plate = robot_model(arm, gripper=None, changer=ToolChangerSpec(thickness_m=0.04, mass_kg=0.5))
    home = np.array(bare.home_rad)
    flange, face = (ArmKinematics(model, base=AT_ORIGIN).tool_pose(home) for model in (bare, with_plate))
    ahead = flange.inverse().then(face)
    assert ahead.xyz == pytest.approx((0.0, 0.0, 0.04), abs=1e-9)
    assert ahead.angle_rad(AT_ORIGIN) < 1e-9
    plate = ET.fromstring(with_plate.urdf_text).find("link[@name='master_plate']/inertial/mass")
    assert plate is not None
    assert plate.attrib["value"] == "0.5"
    assert any("master_plate" in pair for pair in with_plate.allowed_collisions)
    assert with_plate.tool is None
