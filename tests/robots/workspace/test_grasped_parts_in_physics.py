"""What a tool grips goes along in the scene, though nobody has attached it there, until the tool lets it go."""

from __future__ import annotations

import math
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.bus import GoalStatus
from engine.cause_chain import describe_cause
from engine.messages import PartPoses, Pose
from engine.skills.collision_options import CollisionOptions
from engine.skills.gripper import GripperGrasp, GripperOpen
from engine.skills.motion import CartLinTask, CartTrapVel
from engine.skills.planning_scene import DetachPart, ReadPlanningScene
from robots.model.transform import RigidTransform
from tests.robots.workspace.free_cell import FreeCell, free_cell

ONE_PANDA = Path(__file__).parents[1] / "arm" / "one_panda.yaml"
DOWN = (1.0, 0.0, 0.0, 0.0)
AT_BAR, ABOVE_BAR = (Pose(xyz=(-0.15, 0.2, z), xyzw=DOWN) for z in (0.028, 0.15))
"""The fingers around the middle of the bar."""
ACROSS = Pose(xyz=(-0.15, -0.1, 0.15), xyzw=DOWN)
BAR_AND_POST = """
  post: {shape: box, size_m: [0.03, 0.03, 0.3], at: {xyz: [0.01, 0.0, 0.15]}}

parts:
  bar: {shape: box, size_m: [0.36, 0.03, 0.04], mass_kg: 0.15, at: {xyz: [-0.15, 0.2, 0.02]}}
"""
"""The post is beside the path of the hand, and in that of the end of the bar."""


@asynccontextmanager
async def gripping(folder: Path) -> AsyncGenerator[FreeCell]:
    """Open the cell, grasp the bar and lift it; nobody attaches it."""
    file = folder / "cell.yaml"
    file.write_text(ONE_PANDA.read_text(encoding="utf-8").rstrip() + BAR_AND_POST, encoding="utf-8")
    async with free_cell(folder, cell=file) as opened:
        for goal in (CartTrapVel(pose=ABOVE_BAR, speed=0.5), CartLinTask(pose=AT_BAR, duration_s=2.0)):
            assert await perform(opened, goal) == (GoalStatus.SUCCEEDED, "")
        held = await opened.bus.send_goal(GripperGrasp(width_m=0.03, force_n=40.0), to="left/gripper").result()
        assert held.result is not None
        assert held.result.held, held.result.reason
        assert await perform(opened, CartLinTask(pose=ABOVE_BAR, duration_s=2.0)) == (GoalStatus.SUCCEEDED, "")
        yield opened


async def perform(opened: FreeCell, goal: CartLinTask | CartTrapVel) -> tuple[GoalStatus, str]:
    """Carry out a motion; return how it ended and why."""
    end = await opened.bus.send_goal(goal, to="left").result()
    return end.status, describe_cause(end.cause) if end.cause else ""


async def held_parts(opened: FreeCell) -> list[tuple[str, str]]:
    """Return the parts that arms hold in the scene."""
    scene = await opened.bus.call(ReadPlanningScene(), to="cell")
    return [(held.name, held.robot) for held in scene.held]


def bar_turned_rad(opened: FreeCell) -> float:
    """Return by how much the bar has turned from where it lay."""
    poses = opened.bus.topic("cell/parts", PartPoses).latest
    assert poses is not None
    lay = RigidTransform.from_pose(Pose(xyz=(0.0, 0.0, 0.0)))
    return lay.angle_rad(RigidTransform.from_pose(poses.poses["bar"]))


@pytest.mark.virtual
async def test_a_line_on_which_only_a_gripped_part_would_touch_something_is_refused_with_both_names(
    tmp_path: Path,
) -> None:
    """The same line that does not look turns the part in the fingers at the post."""
    line = CartLinTask(pose=ACROSS, duration_s=4.0)
    async with gripping(tmp_path) as opened:
        assert await held_parts(opened) == [("bar", "left")]
        status, why = await perform(opened, line)
        assert (status, "bar would touch post" in why) == (GoalStatus.REJECTED, True), why
        assert bar_turned_rad(opened) < math.radians(5.0)
        blind = CartLinTask(pose=ACROSS, duration_s=4.0, collisions=CollisionOptions(avoid=False))
        await perform(opened, blind)
        assert bar_turned_rad(opened) > math.radians(10.0)


@pytest.mark.virtual
async def test_a_part_that_is_let_go_is_no_longer_in_the_tool_and_one_that_is_detached_is_put_down(
    tmp_path: Path,
) -> None:
    async with gripping(tmp_path) as opened:
        assert await perform(opened, CartLinTask(pose=AT_BAR, duration_s=2.0)) == (GoalStatus.SUCCEEDED, "")
        assert await held_parts(opened) == [("bar", "left")]
        await opened.bus.call(DetachPart(part="bar"), to="cell")
        assert await held_parts(opened) == []
        await opened.bus.send_goal(GripperOpen(), to="left/gripper").result()
        assert await held_parts(opened) == []
        again = await opened.bus.send_goal(GripperGrasp(width_m=0.03, force_n=40.0), to="left/gripper").result()
        assert again.result is not None
        assert await held_parts(opened) == [("bar", "left")]
        await opened.bus.send_goal(GripperOpen(), to="left/gripper").result()
        assert await held_parts(opened) == []
        assert await perform(opened, CartLinTask(pose=ABOVE_BAR, duration_s=2.0)) == (GoalStatus.SUCCEEDED, "")
        assert await perform(opened, CartLinTask(pose=ACROSS, duration_s=4.0)) == (GoalStatus.SUCCEEDED, "")
