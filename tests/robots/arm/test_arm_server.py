"""Motion skills over a fake port: results, rejections, preemption, hold, failure, stop."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from engine.bus import GoalStatus, SkillBus
from engine.clock import new_clock
from engine.errors import RobotError, SkillFailed
from engine.messages import Pose, RobotDescription
from engine.robot import DeviceStatus, Robot
from engine.skill import Action
from engine.skills.gripper import ReadGripper
from engine.skills.motion import (
    CartLinTask,
    CartMotionFeedback,
    CartTrapVel,
    ForwardKinematics,
    JointMotionFeedback,
    JointTrapVel,
)
from robots.arm import ArmServer
from robots.gripper import GripperServer
from tests.robots.fake_port import FakeArmPort, FakeGripperPort
from tests.robots.panda_arm import BASE, home, panda_kinematics, panda_model

DOWN = (1.0, 0.0, 0.0, 0.0)
ELSEWHERE = (0.4, -0.4, 0.1, -2.0, 0.0, 1.6, 0.9)
THERE = Pose(xyz=(-0.15, 0.2, 0.3), xyzw=DOWN)


@dataclass(frozen=True)
class Served:
    """A bus with one arm on it."""

    bus: SkillBus
    arm: ArmServer
    port: FakeArmPort


def new_port(*, velocity_rad_s: float = 0.0) -> FakeArmPort:
    """A Panda at home."""
    return FakeArmPort(panda_model().arm_joints, home(), velocity_rad_s=velocity_rad_s)


def new_arm(port: FakeArmPort, *, gripper: GripperServer | None = None) -> ArmServer:
    """The left arm of the cell."""
    return ArmServer(
        name="left",
        model=panda_model(),
        base=BASE.to_pose("world"),
        port=port,
        clock=new_clock(),
        gripper=gripper,
    )


@asynccontextmanager
async def served() -> AsyncGenerator[Served]:
    """The left arm, connected and on a bus."""
    port = new_port()
    async with SkillBus(new_clock()) as bus, new_arm(port) as arm:
        arm.register(bus)
        yield Served(bus, arm, port)


@pytest.mark.virtual
async def test_a_joint_motion_ends_at_the_goal_and_says_how_long_it_took() -> None:
    """The measured configuration is the result; the time is the trajectory's."""
    async with served() as cell:
        end = await cell.bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left").result()
        way = cell.port.followed[0]
    assert end.result is not None
    assert (end.status, end.result.joints) == (GoalStatus.SUCCEEDED, ELSEWHERE)
    assert end.result.duration_s == pytest.approx(way.duration_s, abs=1e-6)


@pytest.mark.virtual
async def test_feedback_comes_at_twenty_hertz_and_progress_rises() -> None:
    """From the start to 1 at the end."""
    async with served() as cell:
        heard: list[JointMotionFeedback] = []
        handle = cell.bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left")
        handle.on_feedback(heard.append)
        end = await handle.result()
    assert end.result is not None
    progress = [message.progress for message in heard]
    assert progress == sorted(progress)
    assert progress[-1] == 1.0
    assert len(heard) == pytest.approx(end.result.duration_s * 20, abs=2)
    assert heard[-1].joints == ELSEWHERE


@pytest.mark.virtual
@pytest.mark.parametrize("kind", ["joint space", "line"])
async def test_a_cartesian_motion_brings_the_tool_to_the_pose(kind: str) -> None:
    """By inverse kinematics, or straight."""
    goal = CartTrapVel(pose=THERE, speed=0.5) if kind == "joint space" else CartLinTask(pose=THERE, duration_s=2.0)
    async with served() as cell:
        heard: list[CartMotionFeedback] = []
        handle = cell.bus.send_goal(goal, to="left")
        handle.on_feedback(heard.append)
        end = await handle.result()
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    assert end.result is not None
    assert np.allclose(end.result.pose.xyz, THERE.xyz, atol=1e-4)
    assert abs(np.dot(end.result.pose.xyzw, DOWN)) == pytest.approx(1.0, abs=1e-6)
    assert heard[-1].pose == end.result.pose


@pytest.mark.virtual
async def test_a_pose_in_the_base_frame_is_understood() -> None:
    """The same place by another name."""
    in_base = Pose(xyz=(0.4, 0.2, 0.3), xyzw=DOWN, frame="left/panda_link0")
    async with served() as cell:
        end = await cell.bus.send_goal(CartTrapVel(pose=in_base, speed=0.5), to="left").result()
    assert end.result is not None
    assert np.allclose(end.result.pose.xyz, THERE.xyz, atol=1e-4)


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("goal", "words"),
    [
        (JointTrapVel(joints=(0.0,) * 6, speed=0.5), "the goal has 6 joints (this arm has 7)"),
        (JointTrapVel(joints=(0.0,) * 7, speed=0.5), "panda_joint4 cannot go to 0.0000 rad"),
        (CartTrapVel(pose=Pose(xyz=(2.0, 0.0, 0.3), xyzw=DOWN), speed=0.5), "is out of reach by 1."),
        (CartTrapVel(pose=Pose(xyz=(0.0, 0.0, 0.3), frame="tray"), speed=0.5), "the frame 'tray' is not known"),
        (CartLinTask(pose=THERE, duration_s=0.1), "(allow at least 0."),
    ],
)
async def test_what_cannot_be_done_is_rejected_with_the_reason_and_nothing_moves(
    goal: Action[Any, Any], words: str
) -> None:
    """Planned before accepted."""
    async with served() as cell:
        end = await cell.bus.send_goal(goal, to="left").result()
        assert end.cause is not None
        assert (end.status, cell.port.followed) == (GoalStatus.REJECTED, [])
        assert words in end.cause.message


@pytest.mark.virtual
async def test_a_second_goal_is_rejected_while_one_runs() -> None:
    """One motion at a time per arm, whichever skill."""
    async with served() as cell:
        first = cell.bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left")
        await first.accepted()
        second = await cell.bus.send_goal(CartTrapVel(pose=THERE, speed=0.5), to="left").result()
        end = await first.result()
    assert (second.status, end.status) == (GoalStatus.REJECTED, GoalStatus.SUCCEEDED)


@pytest.mark.virtual
async def test_a_preempted_goal_is_canceled_at_rest_and_the_next_is_accepted_at_once() -> None:
    """RCL 4.3: no restart after a preemption; the result is where the arm stopped."""
    async with served() as cell:
        handle = cell.bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left")
        await cell.bus.clock.sleep(0.5)
        handle.cancel()
        canceled = await handle.result()
        assert cell.port.motion is not None
        at_rest, where = cell.port.motion.ended, cell.port.sample().position_rad
        following = await cell.bus.send_goal(JointTrapVel(joints=tuple(home()), speed=0.5), to="left").result()
    assert canceled.result is not None
    assert (canceled.status, at_rest, canceled.result.joints) == (GoalStatus.CANCELED, True, tuple(where.tolist()))
    assert following.status is GoalStatus.SUCCEEDED
    assert 0.001 < np.abs(where - home()).max() < np.abs(np.array(ELSEWHERE) - home()).max()


@pytest.mark.virtual
async def test_a_held_motion_stays_where_it_is_and_goes_on_when_resumed() -> None:
    """The work is paused, not only unwatched."""
    async with served() as cell:
        handle = cell.bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left")
        await cell.bus.clock.sleep(0.5)
        await handle.hold()
        before = cell.port.sample().position_rad
        await cell.bus.clock.sleep(10.0)
        after = cell.port.sample().position_rad
        await handle.resume()
        end = await handle.result()
    assert (before == after).all()
    assert end.result is not None
    assert (end.status, end.result.joints) == (GoalStatus.SUCCEEDED, ELSEWHERE)
    assert end.result.duration_s > 10.0


@pytest.mark.virtual
async def test_the_reason_of_the_device_is_the_cause_of_a_failure_and_the_arm_can_go_on() -> None:
    """A collision on the way."""
    async with served() as cell:
        handle = cell.bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left")
        await cell.bus.clock.sleep(0.5)
        assert cell.port.motion is not None
        cell.port.motion.fail("panda_joint2 is 0.2 rad behind its set point; left hand touches fixture table")
        failed = await handle.result()
        following = await cell.bus.send_goal(JointTrapVel(joints=tuple(home()), speed=0.5), to="left").result()
    assert failed.cause is not None
    assert failed.status is GoalStatus.ABORTED
    assert failed.cause.chain()[-1].message.endswith("left hand touches fixture table")
    assert following.status is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_a_stop_ends_the_motion_at_rest_and_names_itself_as_the_cause() -> None:
    """Not a success, and not canceled by its sender."""
    async with served() as cell:
        handle = cell.bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left")
        await cell.bus.clock.sleep(0.5)
        moving = cell.arm.status
        await cell.arm.stop()
        end = await handle.result()
        assert (moving, cell.arm.status) == (DeviceStatus.MOVING, DeviceStatus.READY)
    assert end.cause is not None
    assert (end.status, end.cause.message) == (GoalStatus.ABORTED, "the arm was stopped by another command")


async def test_a_stop_while_a_motion_is_planned_in_a_thread_prevents_it() -> None:
    """In real time the plan is made beside the loop; nothing may start after the stop."""
    async with served() as cell:
        handle = cell.bus.send_goal(CartLinTask(pose=THERE, duration_s=2.0), to="left")
        while not handle.finished and not cell.port.followed:
            await cell.arm.stop()
            await cell.bus.clock.sleep(0.0)
        end = await handle.result()
    assert (end.status, cell.port.followed) == (GoalStatus.REJECTED, [])


@pytest.mark.virtual
async def test_an_arm_that_does_not_stand_still_after_a_stop_is_a_fault() -> None:
    """Rest is measured, not assumed."""
    arm = new_arm(new_port(velocity_rad_s=0.3))
    await arm.__aenter__()
    with pytest.raises(RobotError, match=r"panda_joint1 still moves at 0\.300 rad/s"):
        await arm.stop()
    assert arm.status is DeviceStatus.FAULT


@pytest.mark.virtual
async def test_an_arm_with_other_joints_than_its_model_is_refused() -> None:
    """A wrong `model` in the cell document."""
    port = FakeArmPort(("shoulder", "elbow"), np.zeros(2))
    with pytest.raises(RobotError, match="the arm reports the joints shoulder, elbow"):
        await new_arm(port).__aenter__()


@pytest.mark.virtual
async def test_an_arm_that_is_not_connected_rejects_goals() -> None:
    """Before `async with`."""
    async with SkillBus(new_clock()) as bus:
        new_arm(new_port()).register(bus)
        end = await bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left").result()
    assert end.cause is not None
    assert (end.status, end.cause.message.partition(" (")[0]) == (GoalStatus.REJECTED, "the arm is disconnected")


@pytest.mark.virtual
async def test_leaving_the_arm_stops_it() -> None:
    """Also with a goal under way."""
    port = new_port()
    async with SkillBus(new_clock()) as bus:
        async with new_arm(port) as arm:
            arm.register(bus)
            handle = bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left")
            await bus.clock.sleep(0.5)
        assert port.motion is not None
        assert (port.motion.ended, arm.status) == (True, DeviceStatus.DISCONNECTED)
        await handle.result()


@pytest.mark.virtual
async def test_a_killed_goal_still_brings_the_arm_to_rest() -> None:
    """As when the loop closes down: the task is cancelled without a request to the goal."""
    async with served() as cell:
        handle = cell.bus.send_goal(JointTrapVel(joints=ELSEWHERE, speed=0.5), to="left")
        await cell.bus.clock.sleep(0.5)
        (task,) = (task for task in asyncio.all_tasks() if task.get_name().startswith("goal"))
        task.cancel()
        await asyncio.wait((task,))
        assert cell.port.motion is not None
        assert (handle.finished, cell.port.motion.ended, cell.arm.status) == (True, True, DeviceStatus.READY)


@pytest.mark.virtual
async def test_forward_kinematics_answers_for_given_and_for_measured_joints() -> None:
    """In the world frame."""
    async with served() as cell:
        given = await cell.bus.call(ForwardKinematics(joints=ELSEWHERE), to="left")
        measured = await cell.bus.call(ForwardKinematics(), to="left")
        with pytest.raises(SkillFailed, match="got 2 joints"):
            await cell.bus.call(ForwardKinematics(joints=(0.0, 1.0)), to="left")
    assert given == panda_kinematics().tool_pose(np.array(ELSEWHERE)).to_pose("world")
    assert measured == panda_kinematics().tool_pose(home()).to_pose("world")


@pytest.mark.virtual
async def test_the_description_is_the_latest_value_of_its_topic() -> None:
    """For whoever looks at the cell later."""
    async with served() as cell:
        description = cell.bus.topic("left/description", RobotDescription).latest
        assert isinstance(cell.arm, Robot)
    assert description is not None
    assert (description.name, description.model, description.base.xyz) == ("left", "panda", (-0.55, 0.0, 0.0))
    assert description.joint_names == panda_model().arm_joints
    assert "panda_link0" in description.urdf


@pytest.mark.virtual
async def test_the_gripper_is_served_and_stopped_with_its_arm() -> None:
    """Under `<arm>/gripper`."""
    gripper = GripperServer(name="left/gripper", port=FakeGripperPort())
    async with SkillBus(new_clock()) as bus, new_arm(new_port(), gripper=gripper) as arm:
        arm.register(bus)
        state = await bus.call(ReadGripper(), to="left/gripper")
    assert state.width_m == 0.08
