"""Movement primitives over a fake port: carried out, refused with the reason, learned from recordings."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
import pytest

from engine.bus import GoalEnd, GoalStatus
from engine.errors import SkillFailed, StoreError
from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.skill import Action
from engine.skills.dmp import CartDMP, JointDMP, LearnCartDmp, LearnedCartDmp, LearnedJointDmp, LearnJointDmp
from engine.skills.motion import CartMotionFeedback, JointMotionFeedback
from engine.store import SqliteStore, register_store
from robots.model.transform import RigidTransform
from robots.motion.min_jerk import min_jerk
from tests.robots.arm.served import Served, served
from tests.robots.panda_arm import BASE, home, panda_kinematics, panda_model

WAY = np.array([0.4, 0.2, -0.2, 0.3, 0.1, 0.2, -0.3])
LED_S = 2.0


def led(*, with_poses: bool = False) -> Trajectory:
    """The arm led from home by `WAY`, with a rest before and after."""
    times = np.arange(0.0, LED_S + 0.6, 0.01)
    joints = home() + WAY * min_jerk((times - 0.3) / LED_S)[:, None]
    tools = [panda_kinematics().tool_pose(row) for row in joints] if with_poses else []
    return Trajectory(
        times_s=tuple(times.tolist()),
        joints=tuple(tuple(row) for row in joints.tolist()),
        names=panda_model().arm_joints,
        poses=tuple((*tool.xyz.tolist(), *tool.xyzw.tolist()) for tool in tools),
    )


async def learned_joint(cell: Served) -> LearnedJointDmp:
    """What the arm learns."""
    return await cell.bus.call(LearnJointDmp(trajectory=led()), to="left")


@pytest.mark.virtual
async def test_a_recording_in_the_store_is_learned_and_carried_out() -> None:
    """The arm ends where it was led to, after tau, and says where it is on the way."""
    async with served() as cell, SqliteStore.open(":memory:", inline=True) as store:
        register_store(cell.bus, store)
        await store.put("trajectory", "wave", msgspec.to_builtins(led()))
        learned = await cell.bus.call(LearnJointDmp(entry="wave"), to="left")
        told: list[JointMotionFeedback] = []
        goal = cell.bus.send_goal(JointDMP(dmp=learned.dmp), to="left")
        goal.on_feedback(told.append)
        end = await goal.result()
    assert learned.fit.max_rad < 2e-3
    assert end.status is GoalStatus.SUCCEEDED
    assert end.result is not None
    assert end.result.joints == pytest.approx(tuple(home() + WAY), abs=2e-3)
    assert end.result.duration_s == pytest.approx(learned.dmp.tau)
    assert [feedback.progress for feedback in told] == sorted(feedback.progress for feedback in told)
    assert told[-1].progress == pytest.approx(1.0)


@pytest.mark.virtual
async def test_a_cartesian_primitive_is_learned_from_joints_and_carried_out() -> None:
    """A recording without tool poses gets them from the arm's kinematics."""
    async with served() as cell:
        learned = await cell.bus.call(LearnCartDmp(trajectory=led()), to="left")
        same = await cell.bus.call(LearnCartDmp(trajectory=led(with_poses=True)), to="left")
        told: list[CartMotionFeedback] = []
        goal = cell.bus.send_goal(CartDMP(dmp=learned.dmp), to="left")
        goal.on_feedback(told.append)
        end = await goal.result()
    assert learned.dmp == same.dmp
    assert end.result is not None
    wanted = panda_kinematics().tool_pose(home() + WAY)
    assert RigidTransform.from_pose(end.result.pose).distance_m(wanted) < 1e-3
    assert RigidTransform.from_pose(end.result.pose).angle_rad(wanted) < 2e-3
    assert told[-1].progress == pytest.approx(1.0)


@pytest.mark.virtual
async def test_other_goals_are_reached() -> None:
    """In joints, and of the tool in the arm's own frame."""
    goal_joints = tuple(home() + WAY + 0.1)
    async with served() as cell:
        learned = await learned_joint(cell)
        first = await cell.bus.send_goal(JointDMP(dmp=learned.dmp, goal=goal_joints), to="left").result()
    assert first.result is not None
    assert first.result.joints == pytest.approx(goal_joints, abs=1e-9)
    async with served() as cell:
        cart = await cell.bus.call(LearnCartDmp(trajectory=led()), to="left")
        there = panda_kinematics().tool_pose(home() + WAY)
        raised = RigidTransform(xyz=there.xyz + np.array([0.0, 0.0, 0.05]), xyzw=there.xyzw)
        pose = BASE.inverse().then(raised).to_pose("left/panda_link0")
        second = await cell.bus.send_goal(CartDMP(dmp=cart.dmp, goal=pose), to="left").result()
    assert second.result is not None
    assert RigidTransform.from_pose(second.result.pose).distance_m(raised) < 1e-5


@pytest.mark.virtual
async def test_a_primitive_that_cannot_be_carried_out_is_rejected_with_the_reason() -> None:
    """An arm elsewhere, a motion too fast, a frame that nobody knows; nothing moves."""
    async with served() as cell:
        joint, cart = (await learned_joint(cell)).dmp, (await _learned_cart(cell)).dmp
        goals: tuple[Action[Any, Any], ...] = (
            JointDMP(dmp=msgspec.structs.replace(joint, y0=tuple(np.array(joint.y0) + 0.5))),
            JointDMP(dmp=msgspec.structs.replace(joint, tau=0.2)),
            JointDMP(dmp=joint, goal=(0.0,)),
            CartDMP(dmp=msgspec.structs.replace(cart, frame="moon")),
            CartDMP(dmp=cart, goal=Pose(xyz=(0.0, 0.0, 0.0), frame="moon")),
        )
        ends = [await _end(cell, goal) for goal in goals]
        followed = list(cell.port.followed)
    assert [end.status for end in ends] == [GoalStatus.REJECTED] * 5
    reasons = [end.cause.message if end.cause is not None else "" for end in ends]
    for reason, words in zip(
        reasons,
        ("panda_joint1 is at", "would need", "its goal has 1 joints", "frame 'moon'", "frame 'moon'"),
        strict=True,
    ):
        assert words in reason
    assert followed == []


@pytest.mark.virtual
async def test_a_cancelled_primitive_leaves_the_arm_at_rest_and_ready() -> None:
    """The next goal is accepted at once."""
    async with served() as cell:
        learned = await learned_joint(cell)
        goal = await cell.begun(JointDMP(dmp=learned.dmp), after_s=0.5)
        goal.cancel()
        end = await goal.result()
        again = JointDMP(dmp=learned.dmp, start_reach_rad=1.0)
        second = await cell.bus.send_goal(again, to="left").result()
    assert end.status is GoalStatus.CANCELED
    assert second.status is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_what_cannot_be_learned_from_fails_with_the_reason() -> None:
    """No such entry, another arm's joints, an arm that was not moved."""
    still = msgspec.structs.replace(led(), joints=(tuple(home().tolist()),) * len(led().times_s))
    renamed = msgspec.structs.replace(led(), names=tuple("abcdefg"))
    async with served() as cell, SqliteStore.open(":memory:", inline=True) as store:
        register_store(cell.bus, store)
        with pytest.raises(StoreError, match="there is no trajectory entry called wav"):
            await cell.bus.call(LearnJointDmp(entry="wav"), to="left")
        with pytest.raises(SkillFailed, match="the recording has the joints a, b") as foreign:
            await cell.bus.call(LearnJointDmp(trajectory=renamed), to="left")
        assert foreign.value.hint is not None
        with pytest.raises(SkillFailed, match="nothing moves in the recording"):
            await cell.bus.call(LearnJointDmp(trajectory=still), to="left")
        with pytest.raises(SkillFailed, match="nothing moves in the recording"):
            await cell.bus.call(LearnCartDmp(trajectory=still), to="left")


async def _learned_cart(cell: Served) -> LearnedCartDmp:
    return await cell.bus.call(LearnCartDmp(trajectory=led()), to="left")


async def _end(cell: Served, goal: Action[Any, Any]) -> GoalEnd[Any]:
    return await cell.bus.send_goal(goal, to="left").result()
