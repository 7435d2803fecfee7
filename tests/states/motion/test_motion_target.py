"""The states of a proposed behavior: in front of a target along the tool, to the start of a motion, as it was led."""

from __future__ import annotations

import math

import msgspec
import pytest

from engine.errors import Cause, SkillFailed
from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import JointDmp
from engine.skills import planning
from engine.skills.dmp import JointDMP, JointFit, LearnedJointDmp, LearnJointDmp, TrimInterval
from engine.skills.entries import EntryRecord
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.motion import (
    CartLinTask,
    CartMotionResult,
    ForwardKinematics,
    InverseKinematics,
    InverseKinematicsResult,
    JointMotionResult,
    JointTrapVel,
)
from engine.skills.planning import FreeMotionResult, MotionTarget
from engine.state import Outcome
from states.motion.follow_recording import FollowRecording
from states.motion.motion_target import PoseTarget
from states.motion.move_free import MoveFree
from states.motion.move_linear import MoveLinear
from states.motion.primitive import MotionStart, RecordingEntry
from tests.states.fake_context import FakeContext, broken_off

HALF = math.sqrt(0.5)
SIDEWAYS = Pose(xyz=(0.4, 0.0, 0.3), xyzw=(0.0, HALF, 0.0, HALF))
"""The z axis of the tool is the x axis of the world."""
WENT = GoalEnd(
    GoalStatus.SUCCEEDED, FreeMotionResult(joints=(0.0,), duration_s=1, stops=0, replans=0, reused=0, waited_s=0), None
)
THERE = GoalEnd(GoalStatus.SUCCEEDED, CartMotionResult(pose=SIDEWAYS, duration_s=1.0), None)
MOVED = GoalEnd(GoalStatus.SUCCEEDED, JointMotionResult(joints=(0.0,), duration_s=1.0), None)
BELOW = Cause(message="it is too far", where="left")
DMP = JointDmp(
    N=2, y0=(0.0, 0.5), dy0=(0.0, 0.0), goal=(1.0, 0.0), tau=2.0, a_z=48.0, a_x=2.0,
    w=((0.0, 0.0), (0.0, 0.0)), c=(1.0, 0.2), sigma=(0.1, 0.1),
)  # fmt: skip
FIT = JointFit(kernels=2, rms_rad=0.0, max_rad=0.0, end_rad=0.0, joint=0, cut=TrimInterval(start_s=0.0, end_s=2.0))
LED = Trajectory(times_s=(0.0, 1.0), joints=((0.1, 0.2), (0.3, 0.4)))
SEEN = Trajectory(times_s=(0.0, 1.0), poses=((*SIDEWAYS.xyz, *SIDEWAYS.xyzw),) * 2)


def entry(kind: str, value: msgspec.Struct) -> EntryRecord:
    return EntryRecord(kind=kind, name="x", value=msgspec.to_builtins(value), revision=1)


def near(*xyz: float) -> object:
    return pytest.approx(xyz, abs=1e-12)


async def test_before_a_pose_is_back_along_the_tool() -> None:
    ctx = FakeContext({"store/read_entry": entry("pose", SIDEWAYS), "left/move_free": WENT})
    assert await MoveFree(robot="left", pose=PoseTarget(entry="x"), back_m=0.1).run(ctx) == Outcome("reached")
    goal = ctx.sent[-1][1]
    assert isinstance(goal, planning.MoveFree)
    assert goal.target.pose is not None
    assert goal.target.pose.xyz == near(0.3, 0.0, 0.3)


async def test_before_joints_the_arm_stands_as_it_does_there() -> None:
    """The nearest configuration to those joints, not any."""
    solution = InverseKinematicsResult(joints=(0.4, 0.6), dexterity=1.0, manipulability=1.0, singular=False)
    ctx = FakeContext(
        {"left/forward_kinematics": SIDEWAYS, "left/inverse_kinematics": solution, "left/move_free": WENT}
    )
    assert await MoveFree(robot="left", joints=(0.5, 0.5), back_m=0.1).run(ctx) == Outcome("reached")
    assert ctx.sent[0][1] == ForwardKinematics(joints=(0.5, 0.5))
    asked = ctx.sent[1][1]
    assert isinstance(asked, InverseKinematics)
    assert (asked.pose.xyz, asked.seed) == (near(0.3, 0.0, 0.3), (0.5, 0.5))
    goal = ctx.sent[2][1]
    assert isinstance(goal, planning.MoveFree)
    assert goal.target == MotionTarget(joints=(0.4, 0.6))


async def test_before_joints_where_the_arm_does_not_reach_is_no_way() -> None:
    """With the reason, and nothing has moved."""
    ctx = FakeContext({"left/forward_kinematics": SIDEWAYS, "left/inverse_kinematics": SkillFailed("out of reach")})
    outcome = await MoveFree(robot="left", joints=(0.5, 0.5), back_m=0.1).run(ctx)
    assert outcome.name == "no_way"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "left did not reach 0.1 m before joints (0.5, 0.5)", "out of reach",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("start", "value", "target"),
    [
        (MotionStart(dmp="x"), entry("dmp", DMP), MotionTarget(joints=DMP.start)),
        (MotionStart(trajectory="x"), entry("trajectory", LED), MotionTarget(joints=(0.1, 0.2))),
        (MotionStart(trajectory="x"), entry("trajectory", SEEN), MotionTarget(pose=SIDEWAYS)),
    ],
)
async def test_a_way_leads_to_where_a_taught_motion_begins(
    start: MotionStart, value: EntryRecord, target: MotionTarget
) -> None:
    ctx = FakeContext({"store/read_entry": value, "left/move_free": WENT})
    assert await MoveFree(robot="left", start_of=start).run(ctx) == Outcome("reached")
    goal = ctx.sent[-1][1]
    assert isinstance(goal, planning.MoveFree)
    assert goal.target == target


async def test_a_start_that_is_not_reached_is_named() -> None:
    ctx = FakeContext({"store/read_entry": entry("dmp", DMP), "left/move_free": broken_off(GoalStatus.REJECTED, BELOW)})
    outcome = await MoveFree(robot="left", start_of=MotionStart(dmp="x")).run(ctx)
    assert outcome.cause is not None
    assert outcome.cause.message.startswith("left did not reach the start of dmp entry x")


async def test_a_straight_line_leads_to_where_the_tool_is_with_joints_and_in_front_of_it() -> None:
    ctx = FakeContext({"left/forward_kinematics": [Pose(xyz=(0, 0, 0)), SIDEWAYS], "left/cart_lin_task": THERE})
    state = MoveLinear(robot="left", joints=(0.5, 0.5), back_m=0.1, duration_s=2.0)
    assert await state.run(ctx) == Outcome("reached")
    goal = ctx.sent[-1][1]
    assert isinstance(goal, CartLinTask)
    assert (goal.pose.xyz, goal.pose.xyzw, goal.duration_s) == (near(0.3, 0.0, 0.3), SIDEWAYS.xyzw, 2.0)


async def test_a_straight_line_leads_back_along_the_tool_from_where_it_is() -> None:
    ctx = FakeContext(
        {"left/forward_kinematics": SIDEWAYS, "left/cart_lin_task": broken_off(GoalStatus.ABORTED, BELOW)}
    )
    outcome = await MoveLinear(robot="left", back_m=0.2, duration_s=2.0).run(ctx)
    goal = ctx.sent[-1][1]
    assert isinstance(goal, CartLinTask)
    assert goal.pose.xyz == near(0.2, 0.0, 0.3)
    assert outcome.cause is not None
    assert "0.2 m before its start pose" in outcome.cause.message


async def test_a_recording_is_learned_and_followed_when_the_state_runs() -> None:
    """Slower, after going to its start."""
    learned = LearnedJointDmp(dmp=DMP, fit=FIT)
    ctx = FakeContext({"left/learn_joint_dmp": learned, "left/joint_trap_vel": MOVED, "left/joint_dmp": MOVED})
    state = FollowRecording(robot="left", recording=RecordingEntry(entry="x"), time_scale=2.0, approach_speed=0.2)
    assert await state.run(ctx) == Outcome("reached")
    assert [request for _, request in ctx.sent] == [
        LearnJointDmp(entry="x"),
        JointTrapVel(joints=DMP.start, speed=0.2),
        JointDMP(dmp=msgspec.structs.replace(DMP, tau=4.0)),
    ]
    assert state.resources() == ("left",)


@pytest.mark.parametrize(
    ("answers", "says"),
    [
        ({"left/learn_joint_dmp": SkillFailed("nothing moves in it")}, "no movement primitive was learned"),
        (
            {
                "left/learn_joint_dmp": LearnedJointDmp(dmp=DMP, fit=FIT),
                "left/joint_dmp": broken_off(GoalStatus.ABORTED, BELOW),
            },
            "left did not follow trajectory entry x to its end",
        ),
    ],
)
async def test_a_recording_that_cannot_be_followed_says_why(answers: dict[str, object], says: str) -> None:
    outcome = await FollowRecording(robot="left", recording=RecordingEntry(entry="x")).run(FakeContext(answers))
    assert outcome.name == "failed"
    assert outcome.cause is not None
    assert outcome.cause.message.startswith(says)


@pytest.mark.parametrize(
    ("state", "given", "message"),
    [
        (MoveFree, {"robot": "l"}, "give either `joints` or `pose`"),
        (MoveFree, {"robot": "l", "joints": [0], "start_of": {"dmp": "x"}}, "`joints`, `pose` or `start_of`"),
        (MoveFree, {"robot": "l", "start_of": {}}, "give one of `dmp`, `cart_dmp` and `trajectory`"),
        (MoveFree, {"robot": "l", "joints": [0], "back_m": -0.1}, "back_m"),
        (MoveLinear, {"robot": "l", "joints": [0], "target": {"entry": "x"}, "duration_s": 1}, "either `target` or"),
    ],
)
def test_what_contradicts_itself_is_refused(state: type[msgspec.Struct], given: object, message: str) -> None:
    with pytest.raises(msgspec.ValidationError, match=message):
        msgspec.convert(given, state)
