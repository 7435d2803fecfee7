"""What is held carries what is joined to it, in the scene of planners too, until the bond breaks."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import GoalStatus, SkillBus
from engine.cause_chain import describe_cause
from engine.messages import PartPoses, Pose
from engine.messages.bonds import BONDS_TOPIC, BondState, CellBonds
from engine.skills.gripper import GripperGrasp
from engine.skills.motion import CartLinTask, CartTrapVel
from engine.skills.planning_scene import ReadPlanningScene
from engine.skills.simulated_world import PushBody
from tests.robots.workspace.free_cell import FreeCell, free_cell

ONE_PANDA = Path(__file__).parents[1] / "arm" / "one_panda.yaml"
DOWN = (1.0, 0.0, 0.0, 0.0)
AT_BAR, ABOVE_BAR, ACROSS = (Pose(xyz=(-0.15, y, z), xyzw=DOWN) for y, z in ((0.2, 0.028), (0.2, 0.15), (-0.1, 0.15)))
JOINED = """
  post: {shape: box, size_m: [0.03, 0.03, 0.3], at: {xyz: [0.01, 0.0, 0.15]}}

parts:
  bar: {shape: box, size_m: [0.16, 0.03, 0.04], mass_kg: 0.1, at: {xyz: [-0.15, 0.2, 0.02]}}
  tail: {shape: box, size_m: [0.098, 0.03, 0.04], mass_kg: 0.05, at: {xyz: [-0.02, 0.2, 0.02]}}

bonds:
  seam: {kind: solder, part: tail, to: bar, at_m: [-0.049, 0, 0], force_n: 15, torque_nm: 2}
"""
"""The post is beside the path of the hand and of the bar, and in that of the tail at its end."""


async def perform(opened: FreeCell, goal: CartLinTask | CartTrapVel) -> tuple[GoalStatus, str]:
    """Carry out a motion; return how it ended and why."""
    end = await opened.bus.send_goal(goal, to="left").result()
    return end.status, describe_cause(end.cause) if end.cause else ""


async def held_parts(bus: SkillBus) -> list[tuple[str, str]]:
    """Return the parts that arms hold in the scene."""
    scene = await bus.call(ReadPlanningScene(), to="cell")
    return sorted((held.name, held.robot) for held in scene.held)


def published(bus: SkillBus) -> tuple[dict[str, BondState], dict[str, tuple[str, ...]]]:
    """Return what is told of bonds, without their loads, and of the parts that they join."""
    bonds, parts = bus.topic(BONDS_TOPIC, CellBonds).latest, bus.topic("cell/parts", PartPoses).latest
    assert bonds is not None
    assert parts is not None
    states = {
        name: BondState(kind=one.kind, part=one.part, to=one.to, broken_by=one.broken_by)
        for name, one in bonds.bonds.items()
    }
    return states, parts.joined


@pytest.mark.virtual
async def test_a_joined_part_is_carried_and_is_left_where_it_comes_off(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(ONE_PANDA.read_text(encoding="utf-8").rstrip() + JOINED, encoding="utf-8")
    async with free_cell(tmp_path, cell=file) as opened:
        bus = opened.bus
        for goal in (CartTrapVel(pose=ABOVE_BAR, speed=0.5), CartLinTask(pose=AT_BAR, duration_s=2.0)):
            assert await perform(opened, goal) == (GoalStatus.SUCCEEDED, "")
        held = await bus.send_goal(GripperGrasp(width_m=0.03, force_n=40.0), to="left/gripper").result()
        assert held.result is not None
        assert held.result.held, held.result.reason
        assert await perform(opened, CartLinTask(pose=ABOVE_BAR, duration_s=2.0)) == (GoalStatus.SUCCEEDED, "")
        seam = BondState(kind="solder", part="tail", to="bar")
        assert published(bus) == ({"seam": seam}, {"bar": ("tail",), "tail": ("bar",)})
        assert await held_parts(bus) == [("bar", "left"), ("tail", "left")]
        status, why = await perform(opened, CartLinTask(pose=ACROSS, duration_s=4.0))
        assert (status, "tail would touch post" in why) == (GoalStatus.REJECTED, True), why

        await bus.call(PushBody(body="tail", force_n=(0.0, 0.0, -30.0), duration_s=0.1), to="cell")
        await bus.clock.sleep(1.0)
        broken = BondState(kind="solder", part="tail", to="bar", broken_by="force")
        assert published(bus) == ({"seam": broken}, {})
        assert await held_parts(bus) == [("bar", "left")]
        scene = await bus.call(ReadPlanningScene(), to="cell")
        assert next(one.pose.xyz[2] for one in scene.obstacles if one.name == "tail") < 0.05
        assert await perform(opened, CartLinTask(pose=ACROSS, duration_s=4.0)) == (GoalStatus.SUCCEEDED, "")
