"""The motion skills on the simulated demo cell: what the torque-controlled arm really does."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus, SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import JointState, Pose
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import CartLinTask, CartMotionFeedback, ForwardKinematics, JointTrapVel
from tests.robots.panda_arm import home

CELL = Path(__file__).parents[3] / "behaviors" / "cells" / "dual_panda.yaml"
DOWN = (1.0, 0.0, 0.0, 0.0)


@asynccontextmanager
async def opened(folder: Path) -> AsyncGenerator[SkillBus]:
    """The bus of the demo cell in lockstep."""
    async with OpenCell(load_cell(CELL), store_path=str(folder / "store.db")) as cell:
        yield cell.bus


def measured_speed(bus: SkillBus) -> float:
    """The fastest joint of the left arm, rad/s."""
    state = bus.topic("left/joint_state", JointState).latest
    assert state is not None
    return max(abs(speed) for speed in state.velocity_rad_s)


@pytest.mark.virtual
async def test_the_tool_really_moves_along_the_line_and_ends_at_the_pose(tmp_path: Path) -> None:
    """Measured within 3 mm of the line on the way and 2 mm of the pose at the end."""
    goal = Pose(xyz=(-0.15, 0.25, 0.3), xyzw=DOWN)
    async with opened(tmp_path) as bus:
        heard: list[CartMotionFeedback] = []
        start = np.array((await bus.call(ForwardKinematics(), to="left")).xyz)
        handle = bus.send_goal(CartLinTask(pose=goal, duration_s=1.5), to="left")
        handle.on_feedback(heard.append)
        end = await handle.result()
    assert end.result is not None
    assert np.linalg.norm(np.subtract(end.result.pose.xyz, goal.xyz)) < 0.002
    along = (np.array(goal.xyz) - start) / np.linalg.norm(np.array(goal.xyz) - start)
    for message in heard:
        off = np.array(message.pose.xyz) - start
        assert np.linalg.norm(off - along * (off @ along)) < 0.003


@pytest.mark.virtual
async def test_a_hold_and_a_cancel_bring_the_measured_arm_to_rest(tmp_path: Path) -> None:
    """Then it goes on, and after the cancel the next goal is carried out."""
    goal = JointTrapVel(joints=(0.8, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8), speed=0.5)
    async with opened(tmp_path) as bus:
        handle = bus.send_goal(goal, to="left")
        await bus.clock.sleep(0.6)
        moving = measured_speed(bus)
        await handle.hold()
        held = measured_speed(bus)
        await handle.resume()
        await bus.clock.sleep(0.3)
        resumed = measured_speed(bus)
        handle.cancel()
        end = await handle.result()
        canceled = measured_speed(bus)
        following = await bus.send_goal(JointTrapVel(joints=tuple(home()), speed=0.5), to="left").result()
    assert min(moving, resumed) > 0.2
    assert max(held, canceled) < 0.02
    assert (end.status, following.status) == (GoalStatus.CANCELED, GoalStatus.SUCCEEDED)


@pytest.mark.virtual
async def test_running_into_the_table_fails_and_names_it(tmp_path: Path) -> None:
    """The device's words travel up as the cause."""
    async with opened(tmp_path) as bus:
        pose = Pose(xyz=(-0.243, 0.0, -0.12), xyzw=DOWN)
        goal = CartLinTask(pose=pose, duration_s=3.0, collisions=CollisionOptions(avoid=False))
        end = await bus.send_goal(goal, to="left").result()
        after = await bus.send_goal(JointTrapVel(joints=tuple(home()), speed=0.5), to="left").result()
    assert end.cause is not None
    assert end.status is GoalStatus.ABORTED
    assert "touches fixture table" in end.cause.chain()[-1].message
    assert after.status is GoalStatus.SUCCEEDED, after.cause
