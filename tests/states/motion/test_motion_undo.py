"""A motion is undone: the arm goes back to where it began, in the same way; where that is unknown it says so."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from engine.errors import Cause, StateError
from engine.messages import Pose
from engine.skill import Action
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.motion import (
    CartLinTask,
    CartMotionResult,
    CartTrapVel,
    ForwardKinematics,
    JointMotionResult,
    JointTrapVel,
)
from engine.state import ActivationRecord, RequestRecord, State
from states.motion.line_duration import line_duration_s
from states.motion.motion_target import PoseTarget
from states.motion.move_joints import MoveJoints
from states.motion.move_linear import MoveLinear
from states.motion.move_pose import MovePose
from tests.states.fake_context import FakeContext, broken_off

START = (0.1, -0.2)
THERE = Pose(xyz=(0.0, 0.0, 0.3))
HERE = Pose(xyz=(0.0, 0.0, 0.1))
JOINTS = MoveJoints(robot="left", target=(0.5, 0.5), speed=0.3)
POSE = MovePose(robot="left", target=PoseTarget(xyz=(0.0, 0.0, 0.3)), speed=0.2)
LINE = MoveLinear(robot="left", target=PoseTarget(xyz=(0.0, 0.0, 0.3)), duration_s=2.0)
BY_SPEED = MoveLinear(robot="left", target=PoseTarget(xyz=(0.0, 0.0, 0.3)), speed_m_s=0.1)
DONE_JOINTS = GoalEnd(GoalStatus.SUCCEEDED, JointMotionResult(joints=START, duration_s=1.0), None)
DONE_LINE = GoalEnd(GoalStatus.SUCCEEDED, CartMotionResult(pose=HERE, duration_s=1.0), None)


def done(goal: type[Action[Any, Any]], result: msgspec.Struct | None, *, status: str = "succeeded") -> ActivationRecord:
    """Return an activation that has sent one goal."""
    plain = msgspec.to_builtins(result) if result is not None else None
    sent = RequestRecord(address=f"left/{goal.skill_name()}", request={}, status=status, result=plain)
    return ActivationRecord(inputs={}, outcome="reached", outputs={}, requests=(sent,))


JOINTS_DONE = done(JointTrapVel, JointMotionResult(joints=(0.5, 0.5), duration_s=1.0, start=START))
POSE_DONE = done(CartTrapVel, CartMotionResult(pose=THERE, duration_s=1.0, start=START))
LINE_DONE = done(CartLinTask, CartMotionResult(pose=THERE, duration_s=2.0, start=START))


@pytest.mark.parametrize(
    ("state", "before", "speed"), [(JOINTS, JOINTS_DONE, 0.3), (POSE, POSE_DONE, 0.2)], ids=["joints", "pose"]
)
async def test_in_joint_space_the_arm_goes_back_at_the_same_speed(
    state: State, before: ActivationRecord, speed: float
) -> None:
    ctx = FakeContext({"left/joint_trap_vel": DONE_JOINTS})
    assert state.cannot_undo(before) == ""
    await state.undo(ctx, before)
    assert ctx.sent == [("left/joint_trap_vel", JointTrapVel(joints=START, speed=speed))]


async def test_a_line_goes_back_on_a_line_in_the_time_that_it_took_but_no_pause_in_it() -> None:
    for took_s, due_s in ((2.0, 2.0), (0.5, 0.5), (60.0, 2.0)):
        before = done(CartLinTask, CartMotionResult(pose=THERE, duration_s=took_s, start=START), status="canceled")
        ctx = FakeContext({"left/forward_kinematics": HERE, "left/cart_lin_task": DONE_LINE})
        await LINE.undo(ctx, before)
        assert ctx.sent == [
            ("left/forward_kinematics", ForwardKinematics(joints=START)),
            ("left/cart_lin_task", CartLinTask(pose=HERE, duration_s=due_s)),
        ]


async def test_a_line_of_a_speed_goes_back_at_that_speed() -> None:
    ctx = FakeContext({"left/forward_kinematics": HERE, "left/cart_lin_task": DONE_LINE})
    await BY_SPEED.undo(ctx, LINE_DONE)
    # 0.2 m with minimum jerk, whose greatest speed is 15/8 of its mean.
    due_s = line_duration_s(THERE, HERE, speed_m_s=0.1)
    assert due_s == pytest.approx(3.75)
    assert ctx.sent[1] == ("left/cart_lin_task", CartLinTask(pose=HERE, duration_s=due_s))


async def test_a_goal_that_was_rejected_has_moved_nothing() -> None:
    ctx = FakeContext()
    rejected = done(JointTrapVel, None, status="rejected")
    assert JOINTS.cannot_undo(rejected) == ""
    await JOINTS.undo(ctx, rejected)
    assert ctx.sent == []


@pytest.mark.parametrize("status", ["", "aborted", "succeeded"])
def test_without_the_configuration_at_its_beginning_there_is_no_way_back(status: str) -> None:
    """After a crash in mid-motion, and in journals of versions before this one."""
    old = JointMotionResult(joints=(0.5, 0.5), duration_s=1.0) if status == "succeeded" else None
    problem = JOINTS.cannot_undo(done(JointTrapVel, old, status=status))
    assert problem == "the start configuration of its motion was not recorded"


async def test_a_way_back_that_fails_says_why() -> None:
    ctx = FakeContext(
        {"left/joint_trap_vel": broken_off(GoalStatus.ABORTED, Cause(message="it touched the tray", where="left"))}
    )
    with pytest.raises(StateError, match=r"left did not return to the start of its motion.*it touched the tray"):
        await JOINTS.undo(ctx, JOINTS_DONE)
