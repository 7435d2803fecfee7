"""What a goal that failed on the way still says: where it has left the arm (RCL 4.3)."""

from __future__ import annotations

from typing import Any

import pytest

from engine.bus import GoalStatus
from engine.messages.primitives import ForceReference
from engine.skill import Action
from engine.skills.dmp import CartAdmitDMP, CartAdmitResult, JointDMP
from engine.skills.jogging import StepTool
from engine.skills.motion import CartMotionResult, JointMotionResult
from tests.robots.arm.every_skill import cart_dmp, joint_dmp
from tests.robots.arm.served import MOVE, served
from tests.robots.panda_arm import home, panda_kinematics

FORCE = ForceReference.constant(force_n=(0.0, 0.0, 5.0))


@pytest.mark.parametrize(
    "goal",
    [
        MOVE,
        JointDMP(dmp=joint_dmp(home(), tuple((home() + 0.1).tolist()))),
        StepTool(step_m=(0.0, 0.0, 0.02)),
        CartAdmitDMP(dmp=cart_dmp(home()), force=FORCE),
    ],
    ids=lambda goal: goal.skill_name(),
)
@pytest.mark.virtual
async def test_a_goal_that_fails_on_the_way_returns_where_the_arm_is(goal: Action[Any, Any]) -> None:
    async with served() as cell:
        handle = await cell.begun(goal, after_s=0.15)
        assert cell.port.motion is not None
        cell.port.motion.fail("panda_joint2 feels 40 N m")
        end = await handle.result()
        left = cell.port.sample().position_rad
    assert end.status is GoalStatus.ABORTED
    if isinstance(end.result, JointMotionResult):
        assert end.result.joints == tuple(left.tolist())
    else:
        assert isinstance(end.result, CartMotionResult | CartAdmitResult)
        assert end.result.pose == panda_kinematics().tool_pose(left).to_pose("world")
    assert end.result.duration_s == pytest.approx(0.15, abs=0.06)
