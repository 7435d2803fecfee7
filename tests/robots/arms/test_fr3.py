"""The FR3 has the kinematics of the Panda and limits of its own."""

from __future__ import annotations

import importlib
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform

FR3 = robot_model("fr3", gripper=None)
ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
franky_sim = find_spec("franky_sim")


@pytest.mark.skipif(franky_sim is None, reason="franky-sim, which has Franka's own description, is not installed")
def test_its_flange_is_where_frankas_own_description_has_it() -> None:
    pinocchio: Any = importlib.import_module("pinocchio")
    assert franky_sim is not None
    assert franky_sim.origin is not None
    described = pinocchio.buildModelFromUrdf(str(Path(franky_sim.origin).parent / "assets" / "fr3_clean.urdf"))
    data = described.createData()
    flange = described.getFrameId("link8")
    kinematics = ArmKinematics(FR3, base=ORIGIN)
    random = np.random.default_rng(7)
    lower, upper = np.array(FR3.limits.lower_rad), np.array(FR3.limits.upper_rad)
    for _ in range(50):
        joints = random.uniform(lower, upper)
        padded = np.zeros(described.nq)
        padded[:7] = joints
        pinocchio.framesForwardKinematics(described, data, padded)
        pose = kinematics.tool_pose(joints)
        assert pose.xyz == pytest.approx(data.oMf[flange].translation, abs=1e-6)
        assert pose.rotation == pytest.approx(data.oMf[flange].rotation, abs=1e-6)


def test_its_range_is_that_of_the_data_sheet() -> None:
    assert FR3.limits.lower_rad == (-2.7437, -1.7837, -2.9007, -3.0421, -2.8065, 0.5445, -3.0159)
    assert FR3.limits.upper_rad == (2.7437, 1.7837, 2.9007, -0.1518, 2.8065, 4.5169, 3.0159)
