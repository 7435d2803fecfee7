"""Linear units on the bus of an open cell: all that knows the base of an arm follows it, and pulls are planned."""

from __future__ import annotations

import math
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from engine.bus import SkillBus
from engine.cause_chain import describe_cause
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.errors import SkillFailed
from engine.messages import FramePoses, Pose, RobotDescription, Vector3
from engine.skill import Action
from engine.skills.device_moves import DeviceFault, MoveDevice, SimulateDeviceFault
from engine.skills.linear_units import LinearUnitReading, PlanBasePull, ReadLinearUnit
from engine.skills.motion import CartLinTask, ForwardKinematics, InverseKinematics, JointTrapVel
from engine.skills.planning import Adaptation, MotionTarget, MoveFree, PlanOptions
from engine.skills.planning_scene import CheckCollision
from engine.skills.simulated_world import PushBody

CELL = Path(__file__).parents[3] / "behaviors" / "cells" / "linear_unit.yaml"
DOWN = (1.0, 0.0, 0.0, 0.0)
TOOL_LINK = "arm/robotiq_2f85_tcp"

pytestmark = pytest.mark.virtual


@asynccontextmanager
async def opened() -> AsyncGenerator[OpenCell]:
    """Open the cell that ships with flexcell, without errors of the arm."""
    async with OpenCell(load_cell(CELL)) as cell:
        yield cell


async def brakes(bus: SkillBus, position: str) -> None:
    """Release or lock the brakes."""
    end = await bus.send_goal(MoveDevice(position=position), to="rail").result()
    assert end.result is not None
    assert end.result.ended == "timed"


async def push(cell: OpenCell, force_n: float) -> None:
    """Push the carriage along the rail for a second."""
    await cell.bus.call(PushBody(body="carriage", force_n=(0.0, force_n, 0.0), duration_s=1.0), to="cell")
    await cell.bus.clock.sleep(2.0)


async def moved(cell: OpenCell) -> LinearUnitReading:
    """Push the carriage to another place, and lock it there."""
    await brakes(cell.bus, "released")
    await push(cell, 80.0)
    await brakes(cell.bus, "locked")
    await cell.bus.clock.sleep(0.3)
    reading = await read(cell.bus)
    assert reading.place_m > 0.1
    return reading


async def ended(cell: OpenCell, goal: Action[Any, Any]) -> str:
    """Return how a motion of the arm ended, with the reason of one that did not succeed."""
    end = await cell.bus.send_goal(goal, to="arm").result()
    return str(end.status) if end.cause is None else f"{end.status}: {describe_cause(end.cause)}"


async def read(bus: SkillBus, place: str = "south") -> LinearUnitReading:
    """Return where the carriage is."""
    return await bus.call(ReadLinearUnit(place=place), to="rail")


def shown(bus: SkillBus, frame: str) -> Vector3:
    """Return where the cell shows a frame."""
    frames = bus.topic("cell/frames", FramePoses).latest
    assert frames is not None
    return frames.xyz[frames.names.index(frame)]


def away_m(bus: SkillBus, pose: Pose) -> float:
    """Return how far the tool centre point is shown from a pose."""
    return math.dist(shown(bus, TOOL_LINK), pose.xyz)


async def test_measured_poses_and_the_description_follow_the_base(tmp_path: Path) -> None:
    async with opened() as cell:
        topic = cell.bus.topic("arm/description", RobotDescription)
        before = topic.latest
        tool = await cell.bus.call(ForwardKinematics(), to="arm")
        off_m = away_m(cell.bus, tool)
        reading = await moved(cell)
        now, after = await cell.bus.call(ForwardKinematics(), to="arm"), topic.latest
        assert before is not None
        assert after is not None
        assert after.base.xyz[1] - before.base.xyz[1] == pytest.approx(reading.place_m, abs=3e-5)
        assert now.xyz[1] - tool.xyz[1] == pytest.approx(reading.place_m, abs=2e-3)
        # What a base really has of errors stays what it was.
        assert away_m(cell.bus, now) == pytest.approx(off_m, abs=1e-3)


async def test_poses_in_the_world_stay_where_they_are_and_joints_keep_theirs() -> None:
    """Lines, profiles and planned motions reach the same place of the world from the new place of the base."""
    goal = Pose(xyz=(0.6, -0.1, 0.7), xyzw=DOWN)
    async with opened() as cell:
        home = await cell.bus.call(InverseKinematics(pose=goal), to="arm")
        assert await ended(cell, MoveFree(target=MotionTarget(pose=goal))) == "succeeded"
        off_m = away_m(cell.bus, goal)
        await moved(cell)
        assert away_m(cell.bus, goal) > 0.1
        there = await cell.bus.call(InverseKinematics(pose=goal), to="arm")
        assert max(abs(one - other) for one, other in zip(home.joints, there.joints, strict=True)) > 0.1
        assert await ended(cell, MoveFree(target=MotionTarget(pose=goal))) == "succeeded"
        assert away_m(cell.bus, goal) == pytest.approx(off_m, abs=1.5e-3)
        up = Pose(xyz=(0.6, -0.1, 0.8), xyzw=DOWN)
        assert await ended(cell, CartLinTask(pose=up, duration_s=2.0)) == "succeeded"
        assert away_m(cell.bus, up) == pytest.approx(off_m, abs=1.5e-3)
        assert await ended(cell, JointTrapVel(joints=home.joints, speed=0.3)) == "succeeded"
        assert away_m(cell.bus, goal) > 0.1


async def test_the_planning_scene_has_the_arm_where_its_base_is() -> None:
    """Joints at which the hand is in the column are free when the base has moved on."""
    async with opened() as cell:
        in_column = Pose(xyz=(0.75, 0.0, 0.36), xyzw=DOWN)
        joints = (await cell.bus.call(InverseKinematics(pose=in_column), to="arm")).joints
        check = CheckCollision(robot="arm", joints=joints)
        assert (await cell.bus.call(check, to="cell")).touching
        await moved(cell)
        assert not (await cell.bus.call(check, to="cell")).touching


async def test_nothing_is_planned_in_the_world_while_the_base_is_released() -> None:
    async with opened() as cell:
        home = await cell.bus.call(ForwardKinematics(), to="arm")
        await brakes(cell.bus, "released")
        for goal in (
            MoveFree(target=MotionTarget(pose=Pose(xyz=(0.6, 0.0, 0.7), xyzw=DOWN))),
            CartLinTask(pose=home, duration_s=1.0),
            JointTrapVel(joints=(0.0,) * 6, speed=0.3),
        ):
            assert "the base of arm is released" in await ended(cell, goal)
        await brakes(cell.bus, "locked")
        assert await ended(cell, CartLinTask(pose=home, duration_s=1.0)) == "succeeded"


@pytest.mark.parametrize(
    "goal",
    [
        MoveFree(
            target=MotionTarget(pose=Pose(xyz=(0.6, -0.1, 0.9), xyzw=DOWN)),
            options=PlanOptions(speed=0.05),
            adaptation=Adaptation(patience_s=5.0),
        ),
        CartLinTask(pose=Pose(xyz=(0.6, -0.1, 0.6), xyzw=DOWN), duration_s=6.0),
    ],
    ids=["planned", "line"],
)
async def test_a_motion_under_way_stops_when_the_base_is_released(goal: Action[Any, Any]) -> None:
    """It fails with the reason when nothing has changed for 5 s, and the clock goes on meanwhile."""
    async with opened() as cell:
        start_s = cell.bus.clock.now_s()
        motion = cell.bus.send_goal(goal, to="arm")
        await cell.bus.clock.sleep(2.7917)
        await brakes(cell.bus, "released")
        end = await motion.result()
        assert str(end.status) == "aborted"
        assert end.cause is not None
        assert "the base of arm is released" in describe_cause(end.cause)
        assert cell.bus.clock.now_s() - start_s < 14.0


async def test_stuck_brakes_stay_closed_and_loose_ones_give_way() -> None:
    async with opened() as cell:
        assert (await cell.bus.call(SimulateDeviceFault(fault=DeviceFault(stuck="brakes")), to="rail")).success
        await brakes(cell.bus, "released")
        await push(cell, 80.0)
        assert (await read(cell.bus)).place_m == pytest.approx(0.0, abs=1e-4)
        await brakes(cell.bus, "locked")
        assert (await cell.bus.call(SimulateDeviceFault(fault=DeviceFault(brakes=False)), to="rail")).success
        await push(cell, 80.0)
        assert (await read(cell.bus)).place_m > 0.1


async def test_a_pull_is_planned_in_the_frame_of_the_base() -> None:
    async with opened() as cell:
        tool = Pose(xyz=(0.75, 0.0, 0.455), xyzw=DOWN)
        pull = await cell.bus.call(PlanBasePull(place="north", tool=tool), to="rail")
        assert (pull.refused, pull.robot, pull.anchor, pull.has_scale) == ("", "arm", "post", True)
        assert (pull.start.frame, pull.goal.frame) == ("arm/base_link", "arm/base_link")
        assert pull.start.xyz == pytest.approx((0.75, 0.4, 0.265), abs=1e-4)
        assert pull.goal.xyz == pytest.approx((0.75, -0.4, 0.265), abs=1e-4)
        assert pull.along == pytest.approx((0.0, 1.0, 0.0), abs=1e-6)


async def test_a_pull_that_cannot_be_says_why_and_by_how_much() -> None:
    async with opened() as cell:
        tool = Pose(xyz=(0.75, 0.0, 0.455), xyzw=DOWN)
        far = await cell.bus.call(PlanBasePull(place_m=0.9, tool=tool), to="rail")
        assert far.refused == "the carriage would be 50.0 mm beyond its travel of -50.0 … 850.0 mm"
        beside = Pose(xyz=(0.75, 0.3, 0.455), xyzw=DOWN)
        off = await cell.bus.call(PlanBasePull(place="north", tool=beside), to="rail")
        assert off.refused == "the tool centre point is 300 mm from the nearest anchor, post"
        with pytest.raises(SkillFailed, match="rail has no place nort") as raised:
            await read(cell.bus, "nort")
        assert "north" in str(raised.value.hint)


async def test_the_scale_reads_the_place_with_its_noise() -> None:
    async with opened() as cell:
        errors = [one.scale_m - one.place_m for one in [await read(cell.bus) for _ in range(50)] if one.scale_m]
        assert 1e-5 < max(errors) < 3e-4
        assert -3e-4 < min(errors) < -1e-5


async def test_a_restored_cell_has_its_base_where_it_was() -> None:
    async with opened() as cell:
        world = cell.world
        assert world is not None
        reading = await moved(cell)
        tool = await cell.bus.call(ForwardKinematics(), to="arm")
        snapshot = world.snapshot()
        await brakes(cell.bus, "released")
        await push(cell, 80.0)
        await brakes(cell.bus, "locked")
        await world.restore(snapshot)
        await cell.bus.clock.sleep(0.3)
        assert (await read(cell.bus)).place_m == pytest.approx(reading.place_m, abs=5e-5)
        assert math.dist((await cell.bus.call(ForwardKinematics(), to="arm")).xyz, tool.xyz) < 2e-3
        await push(cell, 80.0)
        assert (await read(cell.bus)).place_m == pytest.approx(reading.place_m, abs=1e-4)
