"""Parts are put back between trials, and never while a run could move them by it."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from engine.bus import Holder, SkillBus
from engine.cell.open_cell import OpenCell
from engine.clock import new_clock, run_virtual
from engine.document import load_cell
from engine.errors import SkillFailed
from engine.skills.motion import JointTrapVel
from engine.skills.simulated_world import ResetParts
from tests.robots.sim.sim_cell import box, opened, part_xyz, two_arms

CELL = Path(__file__).resolve().parents[4] / "behaviors" / "cells" / "dual_panda.yaml"
AWAY = JointTrapVel(joints=(0.5, -0.5, 0.0, -2.2, 0.0, 1.7, 0.8), speed=0.5)


def test_a_part_that_fell_is_back_where_it_began() -> None:
    """It hangs in the air at the start, falls, and after the reset begins to fall again."""

    async def main() -> tuple[float, float]:
        scene = two_arms(box("dropped", (0.0, 0.4, 0.5)))
        async with opened(scene) as world:
            bus = SkillBus(new_clock())
            world.register(bus)
            await bus.clock.sleep(1.0)
            fallen_m = part_xyz(world, "dropped")[2]
            answer = await bus.call(ResetParts(), to="cell")
            assert answer.parts == ("dropped",)
            await bus.clock.sleep(0.01)
            return fallen_m, part_xyz(world, "dropped")[2]

    fallen_m, again_m = run_virtual(main())
    assert (fallen_m < 0.1, again_m) == (True, pytest.approx(0.5, abs=0.002))


def test_a_body_that_nobody_knows_of_is_reset_too_and_stays_unnamed() -> None:
    async def main() -> tuple[float, float]:
        scene = msgspec.structs.replace(two_arms(), unknown_parts=(box("stray", (0.0, 0.4, 0.5)),))
        async with opened(scene) as world:
            bus = SkillBus(new_clock())
            world.register(bus)
            await bus.clock.sleep(1.0)
            fallen_m = part_xyz(world, "stray")[2]
            answer = await bus.call(ResetParts(), to="cell")
            assert answer.parts == ()
            await bus.clock.sleep(0.01)
            return fallen_m, part_xyz(world, "stray")[2]

    fallen_m, again_m = run_virtual(main())
    assert (fallen_m < 0.1, again_m) == (True, pytest.approx(0.5, abs=0.002))


def test_a_reset_is_refused_while_a_run_holds_an_arm(tmp_path: Path) -> None:
    """The refusal names the run."""

    async def main() -> None:
        async with OpenCell(load_cell(CELL), store_path=str(tmp_path / "s.db")) as cell:
            goal = cell.bus.send_goal(AWAY, to="left", holder=Holder("r1", "root"))
            await goal.accepted()
            with pytest.raises(SkillFailed, match="left is commanded by run r1"):
                await cell.bus.call(ResetParts(), to="cell")
            cell.bus.leases.release_run("r1")
            with pytest.raises(SkillFailed, match="something moves"):
                await cell.bus.call(ResetParts(), to="cell")
            goal.cancel()
            await goal.result()

    run_virtual(main())
