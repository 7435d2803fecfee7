"""The joints of every tool are read off the places of its links."""

from __future__ import annotations

import numpy as np
import pytest

from robots.model.mechanics.pinocchio_model import pin, whole_model
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform
from robots.workspace.tool_joint_estimator import ToolJointEstimator


@pytest.mark.parametrize(
    ("arm", "tool"),
    [("panda", "panda_hand"), ("ur10", "robotiq_2f85"), ("panda", "softhand"), ("servo_arm", "servo_claw")],
)
def test_joints_that_a_model_is_put_to_are_read_again(arm: str, tool: str) -> None:
    model = robot_model(arm, gripper=tool)
    full, random = whole_model(model), np.random.default_rng(3)
    assert model.tool is not None
    data = full.createData()
    for _ in range(20):
        q = np.array(pin.neutral(full))
        wanted = {name: float(random.uniform(-0.5, 0.5)) for name in model.tool.joints}
        for name, value in wanted.items():
            q[full.joints[full.getJointId(name)].idx_q] = value
        pin.framesForwardKinematics(full, data, q)

        def link(name: str) -> RigidTransform:
            at = data.oMf[full.getFrameId(name)]
            return RigidTransform.of(np.array(at.translation), np.array(pin.Quaternion(at.rotation).coeffs()))

        assert dict(ToolJointEstimator(model).read(link)) == pytest.approx(wanted, abs=1e-6)


def test_an_arm_without_a_tool_has_none() -> None:
    def nowhere(_name: str) -> RigidTransform:
        raise AssertionError

    assert ToolJointEstimator(robot_model("ur10", gripper=None)).read(nowhere) == ()
