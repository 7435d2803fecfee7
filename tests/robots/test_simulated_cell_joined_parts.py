"""An arm levers a clipped lid off with its fingertips: the clips give way to the force that they carry."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from engine.bus import GoalStatus, SkillBus
from engine.cause_chain import describe_cause
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import PartPoses, Pose
from engine.messages.bonds import BONDS_TOPIC, CellBonds
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import CartLinTask
from engine.skills.planning import MotionTarget, MoveFree
from engine.skills.simulated_world import ResetParts

CELL = """\
flexcell: 1
cell: lid
world: {kind: mujoco}
robots: {arm: {model: panda, gripper: {model: panda_hand}}}
fixtures:
  housing: {shape: box, size_m: [0.1, 0.08, 0.6], at: {xyz: [0.75, 0, 0.3]}}
parts:
  lid: {shape: box, size_m: [0.16, 0.08, 0.01], mass_kg: 0.05, at: {xyz: [0.75, 0, 0.6051]}}
bonds:
  front_left: {kind: clip, part: lid, to: housing, at_m: [-0.045, 0.035, 0], force_n: 12, point: true}
  front_right: {kind: clip, part: lid, to: housing, at_m: [-0.045, -0.035, 0], force_n: 12, point: true}
  back_left: {kind: clip, part: lid, to: housing, at_m: [0.045, 0.035, 0], force_n: 12, point: true}
  back_right: {kind: clip, part: lid, to: housing, at_m: [0.045, -0.035, 0], force_n: 12, point: true}
"""
FORWARD = (0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5))
"""The fingers point along x, below the edge of the lid that stands out by 30 mm."""
BEFORE, BELOW, UP = (Pose(xyz=(x, 0.0, z), xyzw=FORWARD) for x, z in ((0.6, 0.58), (0.682, 0.58), (0.682, 0.63)))
BLIND = CollisionOptions(avoid=False)


async def perform(bus: SkillBus, goal: CartLinTask) -> tuple[GoalStatus, str]:
    """Carry out a motion; return how it ended and why."""
    end = await bus.send_goal(goal, to="arm").result()
    return end.status, describe_cause(end.cause) if end.cause else ""


def broken(bus: SkillBus) -> dict[str, str]:
    """Return what has broken each clip."""
    bonds = bus.topic(BONDS_TOPIC, CellBonds).latest
    assert bonds is not None
    return {name: bond.broken_by for name, bond in bonds.bonds.items()}


WHOLE = dict.fromkeys(("front_left", "front_right", "back_left", "back_right"), "")


@pytest.mark.virtual
async def test_an_arm_levers_a_lid_off_its_clips_and_a_reset_makes_them_whole(tmp_path: Path) -> None:
    """Which clips give way first depends on where the fingertips slip to; the lid comes off in the end."""
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    async with OpenCell(load_cell(tmp_path / "cell.yaml")) as cell:
        bus = cell.bus
        there = await bus.send_goal(MoveFree(target=MotionTarget(pose=BEFORE)), to="arm").result()
        assert (there.status, there.cause) == (GoalStatus.SUCCEEDED, None)
        below = CartLinTask(pose=BELOW, duration_s=2.0, collisions=BLIND)
        assert await perform(bus, below) == (GoalStatus.SUCCEEDED, "")
        assert broken(bus) == WHOLE
        assert await perform(bus, CartLinTask(pose=UP, duration_s=2.0, collisions=BLIND)) == (GoalStatus.SUCCEEDED, "")
        assert "force" in broken(bus).values()
        for pose in (BELOW, BEFORE):
            goal = CartLinTask(pose=pose, duration_s=2.0, collisions=BLIND)
            assert await perform(bus, goal) == (GoalStatus.SUCCEEDED, "")
        await bus.clock.sleep(1.0)
        parts = bus.topic("cell/parts", PartPoses).latest
        assert parts is not None
        assert (set(broken(bus).values()), parts.joined) == ({"force"}, {})
        assert math.dist(parts.poses["lid"].xyz, (0.75, 0.0, 0.6051)) > 0.02
        await bus.call(ResetParts(), to="cell")
        await bus.clock.sleep(0.2)
        assert broken(bus) == WHOLE
