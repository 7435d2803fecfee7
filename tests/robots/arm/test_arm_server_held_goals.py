"""Goals held and resumed on the demo cell, as a pause of the operator does it."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.bus import GoalStatus, SkillBus
from engine.messages import Pose
from engine.skill import Action
from engine.skills.gripper import GripperGrasp, ReadGripper
from engine.skills.motion import CartLinTask, CartTrapVel, ForwardKinematics, JointTrapVel
from robots.port import Array
from tests.robots.panda_arm import home
from tests.robots.sim.demo_cell import (
    ABOVE_PICK,
    DOWN,
    LIFT,
    PICK,
    joint_state,
    opened_cell,
    part_height_m,
    pick,
    speed_rad_s,
)
from tests.robots.sim.sim_cell import until
from tests.tiers import nightly

THERE = Pose(xyz=(-0.15, 0.25, 0.3), xyzw=DOWN)
JOINTS = JointTrapVel(joints=(0.8, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8), speed=0.4)
POSE = CartTrapVel(pose=THERE, speed=0.4)
LINE = CartLinTask(pose=THERE, duration_s=1.5)
REST_RAD_S = 0.02

arm_goals = pytest.mark.parametrize("goal", [JOINTS, POSE, LINE], ids=["joints", "pose", "line"])


def measured(bus: SkillBus) -> Array:
    """Return the joints of the left arm."""
    return np.array(joint_state(bus).position_rad)


async def tool_xyz(bus: SkillBus) -> Array:
    """Return where the tool is."""
    return np.array((await bus.call(ForwardKinematics(), to="left")).xyz)


def off_line(point: Array, start: Array, end: Array) -> float:
    """Return how far a point is from the straight line between two others."""
    along = (end - start) / np.linalg.norm(end - start)
    return float(np.linalg.norm(point - start - along * ((point - start) @ along)))


async def path_of(bus: SkillBus, goal: Action[Any, Any], *, holds: int) -> tuple[list[Array], list[Array], GoalStatus]:
    """Carry out a goal, held this often on the way; return joints and tool all along, and how it ended."""
    handle = bus.send_goal(goal, to="left")
    joints: list[Array] = []
    tools: list[Array] = []

    async def watch() -> None:
        while not handle.finished:
            joints.append(measured(bus))
            tools.append(await tool_xyz(bus))
            await bus.clock.sleep(0.01)

    watching = asyncio.create_task(watch())
    for hold_s in (5.0, 0.2)[:holds]:
        await until(lambda: speed_rad_s(bus) > 0.1)
        await bus.clock.sleep(0.15)
        await handle.hold()
        at = measured(bus)
        assert (handle.status, speed_rad_s(bus) < REST_RAD_S) == (GoalStatus.HELD, True)
        await bus.clock.sleep(hold_s)
        assert (handle.status, np.abs(measured(bus) - at).max() < 0.001) == (GoalStatus.HELD, True)
        await handle.resume()
        assert handle.status is GoalStatus.ACTIVE
    await watching
    return joints, tools, (await handle.result()).status


@pytest.mark.virtual
@arm_goals
async def test_a_held_goal_takes_the_same_path_to_the_same_end(tmp_path: Path, goal: Action[Any, Any]) -> None:
    """Twice held: no point of the way is off the way of the goal that was left alone."""
    async with opened_cell(tmp_path) as cell:
        joints, _, status = await path_of(cell.bus, goal, holds=0)
    async with opened_cell(tmp_path) as cell:
        held_joints, held_tools, held_status = await path_of(cell.bus, goal, holds=2)
    assert (status, held_status) == (GoalStatus.SUCCEEDED, GoalStatus.SUCCEEDED)
    assert np.abs(held_joints[-1] - joints[-1]).max() < 0.001
    if goal is LINE:
        assert max(off_line(point, held_tools[0], held_tools[-1]) for point in held_tools) < 0.003
    # Samples of the undisturbed way are up to 10 ms apart.
    way = np.array(joints)
    step_rad = float(np.abs(np.diff(way, axis=0)).max())
    assert max(float(np.abs(way - point).max(axis=1).min()) for point in held_joints) < step_rad + 0.003


@pytest.mark.virtual
@arm_goals
@pytest.mark.parametrize("when", ["while it brakes", "when it is held"])
async def test_a_goal_cancelled_during_a_hold_ends_canceled_at_rest(
    tmp_path: Path, goal: Action[Any, Any], when: str
) -> None:
    """And the next goal is taken at once."""
    async with opened_cell(tmp_path) as cell:
        bus = cell.bus
        handle = bus.send_goal(goal, to="left")
        await until(lambda: speed_rad_s(bus) > 0.1)
        await bus.clock.sleep(0.2)
        holding = asyncio.create_task(handle.hold())
        if when == "while it brakes":
            await bus.clock.sleep(0.02)
        else:
            await holding
        handle.cancel()
        end = await handle.result()
        assert (end.status, speed_rad_s(bus) < REST_RAD_S) == (GoalStatus.CANCELED, True)
        await holding
        assert handle.status is GoalStatus.CANCELED
        back = await bus.send_goal(JointTrapVel(joints=tuple(home()), speed=0.5), to="left").result()
        assert back.status is GoalStatus.SUCCEEDED


@pytest.mark.virtual
@arm_goals
@pytest.mark.parametrize("early_s", [0.03, 0.001, *map(nightly, (0.1, 0.01, 0.0))])
async def test_a_goal_held_just_before_its_end_succeeds_when_it_is_resumed(
    tmp_path: Path, goal: Action[Any, Any], early_s: float
) -> None:
    """Its end is known from the same goal in the same cell."""
    async with opened_cell(tmp_path) as cell:
        start_s = cell.bus.clock.now_s()
        await cell.bus.send_goal(goal, to="left").result()
        duration_s, there = cell.bus.clock.now_s() - start_s, measured(cell.bus)
    async with opened_cell(tmp_path) as cell:
        handle = cell.bus.send_goal(goal, to="left")
        await cell.bus.clock.sleep(duration_s - early_s)
        await handle.hold()
        assert speed_rad_s(cell.bus) < REST_RAD_S
        await handle.resume()
        assert (await handle.result()).status is GoalStatus.SUCCEEDED
        assert np.abs(measured(cell.bus) - there).max() < 0.001


@pytest.mark.virtual
async def test_a_stop_during_a_hold_ends_the_goal_at_rest(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        handle = cell.bus.send_goal(JOINTS, to="left")
        await until(lambda: speed_rad_s(cell.bus) > 0.1)
        await handle.hold()
        await cell.robots["left"].stop()
        end = await handle.result()
        assert end.cause is not None
        assert (end.status, end.cause.message) == (GoalStatus.ABORTED, "the arm was stopped by another command")


@pytest.mark.virtual
@pytest.mark.parametrize("width_m", [0.06, 0.0302])
async def test_a_grasp_held_on_its_way_or_on_the_part_holds_the_part_when_resumed(
    tmp_path: Path, width_m: float
) -> None:
    """In the middle of nothing, and with the pads just on it, before the force is built up."""
    async with opened_cell(tmp_path) as cell:
        bus = cell.bus
        for goal in (CartTrapVel(pose=ABOVE_PICK, speed=0.5), CartLinTask(pose=PICK, duration_s=1.0)):
            await bus.send_goal(goal, to="left").result()
        handle = bus.send_goal(GripperGrasp(width_m=0.03, force_n=30.0), to="left/gripper")
        while (await bus.call(ReadGripper(), to="left/gripper")).width_m > width_m:
            await bus.clock.sleep(0.001)
        await handle.hold()
        before = await bus.call(ReadGripper(), to="left/gripper")
        await bus.clock.sleep(3.0)
        after = await bus.call(ReadGripper(), to="left/gripper")
        assert (handle.status, after.width_m) == (GoalStatus.HELD, pytest.approx(before.width_m, abs=0.0002))
        await handle.resume()
        end = await handle.result()
        assert end.result is not None
        assert end.result.held, end.result.reason
        await bus.send_goal(LIFT, to="left").result()
        assert part_height_m(bus) > 0.17


@pytest.mark.virtual
async def test_a_part_stays_in_the_fingers_while_the_arm_that_lifts_it_is_held(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        bus = cell.bus
        await pick(bus)
        handle = bus.send_goal(LIFT, to="left")
        await until(lambda: part_height_m(bus) > 0.08)
        await handle.hold()
        height_m = part_height_m(bus)
        await bus.clock.sleep(3.0)
        assert part_height_m(bus) == pytest.approx(height_m, abs=0.001)
        await handle.resume()
        assert (await handle.result()).status is GoalStatus.SUCCEEDED
        assert part_height_m(bus) == pytest.approx(0.176, abs=0.005)
