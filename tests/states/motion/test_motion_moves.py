"""The states that move an arm: what they ask for and how they word a failure."""

from __future__ import annotations

import math

import msgspec
import pytest

from engine.errors import Cause, EntryNotFound, StateError
from engine.messages import Pose
from engine.skills.entries import EntryRecord, ReadEntry
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.motion import (
    CartLinTask,
    CartMotionResult,
    CartTrapVel,
    ForwardKinematics,
    JointMotionResult,
    JointTrapVel,
)
from engine.state import Outcome
from states.motion.line_duration import SHORTEST_S, line_duration_s
from states.motion.motion_target import EntryTarget, PoseTarget
from states.motion.move_joints import MoveJoints
from states.motion.move_linear import MoveLinear
from states.motion.move_pose import MovePose
from tests.states.fake_context import FakeContext, broken_off

HERE = Pose(xyz=(0.1, 0.2, 0.3))
DONE_JOINTS = GoalEnd(GoalStatus.SUCCEEDED, JointMotionResult(joints=(0.0,), duration_s=1.0), None)
DONE_CART = GoalEnd(GoalStatus.SUCCEEDED, CartMotionResult(pose=HERE, duration_s=1.0), None)
POSE_ENTRY = EntryRecord(kind="pose", name="pick", value={"xyz": [0.1, 0.2, 0.3]}, revision=1)
LIMIT = Cause(message="joint 4 would exceed its limit", where="left/cart_lin_task", kind="GoalRejected")


async def test_joints_given_in_the_behavior_are_commanded() -> None:
    """The goal has the angles and the speed."""
    ctx = FakeContext({"left/joint_trap_vel": DONE_JOINTS})
    state = MoveJoints(robot="left", target=(0.1, -0.2), speed=0.3)
    assert await state.run(ctx) == Outcome("reached")
    assert ctx.sent == [("left/joint_trap_vel", JointTrapVel(joints=(0.1, -0.2), speed=0.3))]


async def test_joints_named_by_an_entry_are_read_when_the_state_runs() -> None:
    """Another value in the store is another motion of the same state."""
    state = MoveJoints(robot="left", target=EntryTarget(entry="home"))
    commanded: list[object] = []
    for angles in ([0.0, 1.0], [0.5, 0.5]):
        entry = EntryRecord(kind="joints", name="home", value={"joints": angles, "names": []}, revision=1)
        ctx = FakeContext({"store/read_entry": entry, "left/joint_trap_vel": DONE_JOINTS})
        await state.run(ctx)
        assert ctx.sent[0] == ("store/read_entry", ReadEntry(kind="joints", name="home"))
        commanded.append(ctx.sent[1][1])
    assert commanded == [JointTrapVel(joints=(0.0, 1.0), speed=0.5), JointTrapVel(joints=(0.5, 0.5), speed=0.5)]


async def test_a_missing_entry_is_an_error_that_names_it() -> None:
    """A typo in a behavior is no motion failure."""
    ctx = FakeContext({"store/read_entry": EntryNotFound("there is no joints entry called hme")})
    with pytest.raises(EntryNotFound, match="hme"):
        await MoveJoints(robot="left", target=EntryTarget(entry="hme")).run(ctx)


async def test_a_failed_joint_motion_names_robot_target_skill_and_reason() -> None:
    """The chain goes from the behavior down to the device."""
    below = Cause(message="joint 2 was held back by hca_north", where="left")
    entry = EntryRecord(kind="joints", name="home", value={"joints": [0.0]}, revision=1)
    ctx = FakeContext({"store/read_entry": entry, "left/joint_trap_vel": broken_off(GoalStatus.ABORTED, below)})
    assert await MoveJoints(robot="left", target=EntryTarget(entry="home")).run(ctx) == Outcome(
        "failed",
        cause=Cause(
            message="left did not reach joints entry home: joint_trap_vel was aborted",
            where="root/step",
            kind="motion.MoveJoints",
            because=below,
        ),
    )


async def test_a_goal_cancelled_from_outside_fails_with_that_reason() -> None:
    """Even without a cause from the device the chain says why."""
    ctx = FakeContext({"left/joint_trap_vel": broken_off(GoalStatus.CANCELED, None)})
    outcome = await MoveJoints(robot="left", target=(0.0,)).run(ctx)
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "left did not reach joints (0): joint_trap_vel was canceled",
        "the goal was cancelled by somebody other than this state",
    ]


async def test_a_pose_entry_with_an_offset_is_commanded_along_the_world() -> None:
    """The offset is added to the entry's position; the orientation stays."""
    ctx = FakeContext({"store/read_entry": POSE_ENTRY, "right/cart_trap_vel": DONE_CART})
    state = MovePose(robot="right", target=PoseTarget(entry="pick"), offset_m=(0.0, 0.0, 0.1), speed=1.0)
    assert await state.run(ctx) == Outcome("reached")
    pose = Pose(xyz=(0.1, 0.2, pytest.approx(0.4)))  # pyright: ignore[reportArgumentType]  compares within rounding
    assert ctx.sent[1] == ("right/cart_trap_vel", CartTrapVel(pose=pose, speed=1.0))


async def test_what_of_the_pose_counts_is_sent_to_the_arm() -> None:
    """All of it, unless the behavior says otherwise."""
    ctx = FakeContext({"right/cart_trap_vel": DONE_CART})
    target = PoseTarget(xyz=(0.1, 0.2, 0.3))
    for state in (
        MovePose(robot="right", target=target),
        MovePose(robot="right", target=target, match="position"),
    ):
        assert await state.run(ctx) == Outcome("reached")
    pose = Pose(xyz=(0.1, 0.2, 0.3))
    assert [goal for _, goal in ctx.sent] == [
        CartTrapVel(pose=pose, speed=0.5, match="pose"),
        CartTrapVel(pose=pose, speed=0.5, match="position"),
    ]


async def test_a_failed_pose_motion_names_the_entry_and_its_offset() -> None:
    """The message tells which of several motions to one entry it was."""
    ctx = FakeContext(
        {
            "store/read_entry": POSE_ENTRY,
            "left/cart_trap_vel": broken_off(GoalStatus.REJECTED, Cause(message="too far")),
        }
    )
    outcome = await MovePose(robot="left", target=PoseTarget(entry="pick"), offset_m=(0, 0, 0.1)).run(ctx)
    assert outcome.name == "failed"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "left did not reach pose entry pick offset by (0.000, 0.000, 0.100) m: cart_trap_vel was rejected",
        "too far",
    ]


async def test_an_offset_to_a_pose_in_another_frame_is_refused() -> None:
    """Adding along the world's axes would be wrong there."""
    target = PoseTarget(xyz=(0, 0, 0), frame="tray")
    with pytest.raises(StateError, match="the target is given in frame tray"):
        await MovePose(robot="left", target=target, offset_m=(0, 0, 0.1)).run(FakeContext())


async def test_a_line_with_a_duration_takes_it_as_it_is() -> None:
    """Nothing else is asked."""
    ctx = FakeContext({"left/cart_lin_task": DONE_CART})
    target = PoseTarget(xyz=(0.4, 0.0, 0.2), xyzw=(1.0, 0.0, 0.0, 0.0))
    assert await MoveLinear(robot="left", target=target, duration_s=2.0).run(ctx) == Outcome("reached")
    pose = Pose(xyz=(0.4, 0.0, 0.2), xyzw=(1.0, 0.0, 0.0, 0.0))
    assert ctx.sent == [("left/cart_lin_task", CartLinTask(pose=pose, duration_s=2.0))]


async def test_a_line_with_a_speed_takes_its_time_from_the_measured_way() -> None:
    """0.08 m with at most 0.1 m/s, minimum jerk: 1.5 s."""
    ctx = FakeContext({"left/forward_kinematics": HERE, "left/cart_lin_task": DONE_CART})
    target = PoseTarget(xyz=(0.1, 0.28, 0.3))
    await MoveLinear(robot="left", target=target, speed_m_s=0.1).run(ctx)
    assert ctx.sent[0] == ("left/forward_kinematics", ForwardKinematics())
    goal = ctx.sent[1][1]
    assert isinstance(goal, CartLinTask)
    assert goal.duration_s == pytest.approx(1.5)


async def test_a_line_without_target_goes_from_where_the_tool_is() -> None:
    """An offset alone lifts."""
    ctx = FakeContext({"left/forward_kinematics": HERE, "left/cart_lin_task": DONE_CART})
    await MoveLinear(robot="left", offset_m=(0.0, 0.0, 0.25), duration_s=1.0).run(ctx)
    assert ctx.sent[1][1] == CartLinTask(pose=Pose(xyz=(0.1, 0.2, 0.55)), duration_s=1.0)


async def test_a_refused_line_carries_the_planners_reason() -> None:
    """The reason for refusing beforehand reaches the behavior."""
    ctx = FakeContext({"left/cart_lin_task": broken_off(GoalStatus.REJECTED, LIMIT)})
    outcome = await MoveLinear(robot="left", target=PoseTarget(xyz=(9, 0, 0)), duration_s=1.0).run(ctx)
    message = "left did not reach pose (9.000, 0.000, 0.000) m on a straight line: cart_lin_task was rejected"
    cause = Cause(message=message, where="root/step", kind="motion.MoveLinear", because=LIMIT)
    assert outcome == Outcome("failed", cause=cause)


async def test_a_speed_to_another_frame_is_refused_with_advice() -> None:
    """The way is not known, so the time cannot be."""
    ctx = FakeContext({"left/forward_kinematics": HERE})
    state = MoveLinear(robot="left", target=PoseTarget(xyz=(0, 0, 0), frame="tray"), speed_m_s=0.1)
    with pytest.raises(StateError, match="give `duration_s` instead"):
        await state.run(ctx)


@pytest.mark.parametrize(
    ("state", "given", "message"),
    [
        (MoveLinear, {"robot": "l", "target": {"entry": "a"}}, "either `duration_s` or `speed_m_s`"),
        (MoveLinear, {"robot": "l", "offset_m": [0, 0, 1], "duration_s": 1, "speed_m_s": 1}, "either `duration_s`"),
        (MoveLinear, {"robot": "l", "duration_s": 1}, "give `target`, `joints`, `offset_m` or `back_m`"),
        (MovePose, {"robot": "l", "target": {}}, "give either `entry` or `xyz`"),
        (MovePose, {"robot": "l", "target": {"entry": "a", "xyz": [0, 0, 0]}}, "give either `entry` or `xyz`"),
        (MoveJoints, {"robot": "l", "target": []}, "target"),
        (MoveJoints, {"robot": "l", "target": {"entri": "a"}}, "entr"),
        (MoveJoints, {"robot": "l", "target": [0.1], "speed": 1.5}, "speed"),
        (MoveJoints, {"robot": "", "target": [0.1]}, "robot"),
    ],
)
def test_parameters_that_contradict_or_lack_something_are_refused(
    state: type[msgspec.Struct], given: dict[str, object], message: str
) -> None:
    """The document check finds it before anything moves."""
    with pytest.raises(msgspec.ValidationError, match=message):
        msgspec.convert(given, state)


def test_each_move_commands_its_arm() -> None:
    """The run leases what a state names here."""
    moves = (
        MoveJoints(robot="left", target=(0.0,)),
        MovePose(robot="left", target=PoseTarget(entry="a")),
        MoveLinear(robot="left", target=PoseTarget(entry="a"), duration_s=1.0),
    )
    assert [move.resources() for move in moves] == [("left",)] * 3


def test_turning_on_the_spot_takes_the_time_of_turning() -> None:
    """A quarter turn at 1 rad/s peak; q and -q are the same orientation; no motion is still finite."""
    half = math.sqrt(0.5)
    turned = Pose(xyz=HERE.xyz, xyzw=(0.0, 0.0, half, half))
    negated = Pose(xyz=HERE.xyz, xyzw=(0.0, 0.0, 0.0, -1.0))
    assert line_duration_s(HERE, turned, speed_m_s=0.1) == pytest.approx(math.pi / 2 * 15 / 8)
    assert line_duration_s(HERE, negated, speed_m_s=0.1) == SHORTEST_S
