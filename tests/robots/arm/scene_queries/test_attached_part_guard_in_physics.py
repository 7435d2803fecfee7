"""What an arm holds is part of every motion that looks for no way: what it would touch is named, and nothing moves."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.cause_chain import describe_cause
from engine.cell.open_cell import OpenCell
from engine.messages import Pose, Vector3
from engine.skill import Action, Service
from engine.skills.contact import MoveUntilContact
from engine.skills.dmp import CartDMP, JointDMP
from engine.skills.jogging import JogTool, StepTool
from engine.skills.motion import CartLinTask, CartTrapVel, ForwardKinematics, InverseKinematics, JointTrapVel
from engine.skills.planning import MotionTarget, MoveFree
from engine.skills.planning_scene import CONTACT_M, AllowContact, AttachPart, DetachPart, PutObstacle
from tests.robots.arm.every_skill import cart_dmp, joint_dmp
from tests.robots.sim.demo_cell import ABOVE_PICK, DOWN, LIFT, PICK, joint_state, opened_cell, pick
from tests.robots.workspace.free_cell import box
from tests.tiers import nightly

PART = "hca_north"
ENDED = tuple[GoalStatus, str]
LID_M = ABOVE_PICK.xyz[2] + 0.035
"""The lower side of something over the part that hangs at `ABOVE_PICK`: 17 mm above it."""


def at(z: float) -> Pose:
    """The tool over the place where the part was."""
    return Pose(xyz=(*PICK.xyz[:2], z), xyzw=DOWN)


@dataclass
class Carrying:
    """The demo cell, in which the left arm holds the part of the north tray."""

    cell: OpenCell

    async def ask(self, request: Service[Any], *, to: str = "cell") -> Any:
        """Ask a service."""
        return await self.cell.bus.call(request, to=to)

    async def end(self, goal: Action[Any, Any]) -> ENDED:
        """Send a goal to the left arm; how it ended, and why."""
        end = await self.cell.bus.send_goal(goal, to="left").result()
        return end.status, describe_cause(end.cause) if end.cause else ""

    async def went(self, goal: Action[Any, Any]) -> None:
        """Send a goal that succeeds."""
        assert await self.end(goal) == (GoalStatus.SUCCEEDED, "")

    async def lid(self) -> None:
        """Put a lid over the part, in the scene alone; the hand, which it crosses, may touch it."""
        x, y, _ = PICK.xyz
        await self.ask(PutObstacle(obstacle=box("lid", (0.2, 0.2, 0.01), (x, y, LID_M + 0.005))))
        await self.ask(AllowContact(first="left", second="lid"))

    async def joints(self, z: float) -> tuple[float, ...]:
        """Where the joints are when the tool is at a height."""
        return (await self.ask(InverseKinematics(pose=at(z)), to="left")).joints


@asynccontextmanager
async def carrying(folder: Path, *, lifted: bool = True, attached: bool = True) -> AsyncGenerator[Carrying]:
    """Open the cell and take the part."""
    async with opened_cell(folder) as cell:
        await pick(cell.bus)
        opened = Carrying(cell)
        if attached:
            await opened.ask(AttachPart(part=PART, robot="left"))
        if lifted:
            await opened.went(LIFT)
        yield opened


async def _joint_trap(opened: Carrying) -> Action[Any, Any]:
    return JointTrapVel(joints=await opened.joints(LID_M + 0.03), speed=0.2)


async def _cart_trap(_: Carrying) -> Action[Any, Any]:
    return CartTrapVel(pose=at(LID_M + 0.03), speed=0.2)


async def _line(_: Carrying) -> Action[Any, Any]:
    return CartLinTask(pose=at(LID_M + 0.03), duration_s=1.0)


async def _joint_primitive(opened: Carrying) -> Action[Any, Any]:
    now = np.array(joint_state(opened.cell.bus).position_rad)
    return JointDMP(dmp=joint_dmp(now, await opened.joints(LID_M + 0.03)))


async def _cart_primitive(opened: Carrying) -> Action[Any, Any]:
    """It lifts by 3 cm."""
    return CartDMP(dmp=cart_dmp(np.array(joint_state(opened.cell.bus).position_rad)))


@pytest.mark.virtual
@pytest.mark.parametrize("make", [_joint_trap, _line, _cart_primitive, *map(nightly, (_cart_trap, _joint_primitive))])
async def test_a_motion_that_would_push_the_part_into_something_is_refused_with_both_names(
    tmp_path: Path, make: Callable[[Carrying], Any]
) -> None:
    """It succeeds without the lid, where the two may touch, and with the same in the way of an empty hand."""
    async with carrying(tmp_path) as opened:
        await opened.lid()
        status, why = await opened.end(await make(opened))
        assert (status, f"{PART} would touch lid" in why or f"lid would touch {PART}" in why) == (
            GoalStatus.REJECTED,
            True,
        ), why
        await opened.ask(AllowContact(first=PART, second="lid"))
        await opened.went(await make(opened))


@pytest.mark.virtual
async def test_a_part_is_put_down_where_it_stands_and_not_deeper(tmp_path: Path) -> None:
    """Contact at the end of the way is what a place is for; 15 mm of it are not."""
    async with carrying(tmp_path) as opened:
        status, why = await opened.end(CartLinTask(pose=at(PICK.xyz[2] - 0.015), duration_s=1.0))
        assert (status, f"{PART} would touch tray_north" in why) == (GoalStatus.REJECTED, True), why
        await opened.went(CartLinTask(pose=at(PICK.xyz[2] - 0.001), duration_s=1.0))


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("goal", "other"),
    [
        (CartLinTask(pose=at(PICK.xyz[2] - 0.015), duration_s=1.0), "tray_north"),
        (CartLinTask(pose=Pose(xyz=(PICK.xyz[0] - 0.06, *PICK.xyz[1:]), xyzw=DOWN), duration_s=1.0), "tray_north"),
        (MoveFree(target=MotionTarget(pose=Pose(xyz=(PICK.xyz[0] - 0.045, *PICK.xyz[1:]), xyzw=DOWN))), "tray_north"),
        (StepTool(step_m=(0.0, 0.0, -0.015), speed_m_s=0.05), "table"),
    ],
    ids=["down", "into the wall of the tray", "planned into the wall of the tray", "a step down"],
)
async def test_what_a_part_lies_on_is_no_way_for_it(tmp_path: Path, goal: Action[Any, Any], other: str) -> None:
    """It may be lifted from there, and dragged along on it, but not be pushed into it.

    A step keeps 5 mm away from the table, too, which is 6 mm below.
    """
    async with carrying(tmp_path, lifted=False) as opened:
        status, why = await opened.end(goal)
        assert (status, f"{PART} would touch {other}" in why) == (GoalStatus.REJECTED, True), why
        await opened.went(CartLinTask(pose=Pose(xyz=(PICK.xyz[0] + 0.02, *PICK.xyz[1:]), xyzw=DOWN), duration_s=1.0))
        await opened.went(LIFT)


@pytest.mark.virtual
@pytest.mark.parametrize("attached", [True, False])
async def test_a_jog_presses_no_part_into_what_it_stands_on(tmp_path: Path, attached: bool) -> None:
    """Down it stands at once, along the surface and up it goes; told of the scene or gripped only."""
    async with carrying(tmp_path, lifted=False, attached=attached) as opened:
        # Or the margin of the table under the tray would hold the arm.
        await opened.ask(AllowContact(first=PART, second="table"))
        await opened.ask(AllowContact(first="left", second="table"))
        await opened.ask(AllowContact(first="left", second="tray_north"))

        async def jogged_m(velocity: Vector3) -> Vector3:
            before = await opened.ask(ForwardKinematics(), to="left")
            await opened.went(JogTool(velocity=(*velocity, 0.0, 0.0, 0.0), duration_s=1.0))
            after = await opened.ask(ForwardKinematics(), to="left")
            return tuple(b - a for a, b in zip(before.xyz, after.xyz, strict=True))

        assert (await jogged_m((0.0, 0.0, -0.05)))[2] > -CONTACT_M - 0.001
        assert (await jogged_m((0.0, 0.0, 0.05)))[2] > 0.03


@pytest.mark.virtual
async def test_steps_towards_a_surface_do_not_add_up(tmp_path: Path) -> None:
    """Each of them alone would be contact at its end."""
    async with carrying(tmp_path) as opened:
        ends: list[GoalStatus] = []
        for millimetres in range(0, 12, 2):
            pose = at(PICK.xyz[2] - millimetres / 1000)
            ends.append((await opened.end(CartLinTask(pose=pose, duration_s=1.0)))[0])
        assert ends == [GoalStatus.SUCCEEDED] * 3 + [GoalStatus.REJECTED] * 3


@pytest.mark.virtual
async def test_another_arm_is_nothing_to_put_a_part_down_on(tmp_path: Path) -> None:
    async with carrying(tmp_path) as opened:
        right = await opened.ask(InverseKinematics(pose=Pose(xyz=(0.06, 0.28, 0.35), xyzw=DOWN)), to="right")
        end = await opened.cell.bus.send_goal(JointTrapVel(joints=right.joints, speed=0.5), to="right").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        there = Pose(xyz=(0.06, 0.28, 0.37), xyzw=DOWN)
        status, why = await opened.end(CartLinTask(pose=there, duration_s=3.0))
        assert (status, f"{PART} would touch right/" in why) == (GoalStatus.REJECTED, True), why


@pytest.mark.virtual
async def test_what_is_gripped_is_known_though_nobody_has_attached_it_and_what_is_detached_no_more(
    tmp_path: Path,
) -> None:
    """One who detaches a part that is still in the grip means it as put down."""
    async with carrying(tmp_path, attached=False) as opened:
        await opened.lid()
        status, why = await opened.end(await _line(opened))
        assert (status, f"{PART} would touch lid" in why) == (GoalStatus.REJECTED, True), why
        await opened.ask(DetachPart(part=PART))
        await opened.went(await _line(opened))


@pytest.mark.virtual
async def test_a_motion_whose_purpose_is_contact_may_touch(tmp_path: Path) -> None:
    """It goes until the environment pushes back."""
    async with carrying(tmp_path) as opened:
        await opened.went(MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.2, speed_m_s=0.05, force_n=10.0))
