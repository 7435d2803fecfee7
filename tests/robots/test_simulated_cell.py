"""A cell document's world with its robots on the bus."""

from __future__ import annotations

from pathlib import Path

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document.cell import load_cell
from engine.messages import PartPoses
from engine.skills.gripper import GripperGrasp
from engine.skills.motion import JointTrapVel
from robots.simulated_cell import new_world

CELL = Path(__file__).parents[2] / "behaviors" / "cells" / "dual_panda.yaml"


async def scenario(seed: int) -> tuple[str, str, str]:
    """Move one arm and one gripper of the shipped cell; return in words all that was measured at the end."""
    async with SkillBus(new_clock()) as bus, new_world(load_cell(CELL), bus=bus, virtual=True, seed=seed) as world:
        world.register(bus)
        for robot in world.robots():
            robot.register(bus)
            await robot.__aenter__()
        goal = JointTrapVel(joints=(0.1, -0.5, 0.0, -2.2, 0.0, 1.7, 0.7), speed=0.5)
        arm = bus.send_goal(goal, to="left")
        fingers = bus.send_goal(GripperGrasp(width_m=0.03), to="right/gripper")
        ends = await arm.result(), await fingers.result()
        return str(ends[0]), str(ends[1]), str(bus.topic("cell/parts", PartPoses).latest)


def test_the_robots_of_a_cell_answer_their_skills_and_the_same_seed_gives_the_same_numbers() -> None:
    arm, fingers, parts = run_virtual(scenario(5))
    assert (arm, fingers, parts) == run_virtual(scenario(5))
    assert parts != run_virtual(scenario(6))[2]
    assert "succeeded" in arm.lower()
    assert "touch nothing" in fingers
