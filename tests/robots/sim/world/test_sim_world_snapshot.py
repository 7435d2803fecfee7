"""An open cell is brought back: arms, parts, and what the grippers were told to hold."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import GoalStatus
from engine.cell.open_cell import OpenCell
from engine.errors import CellError, RobotError
from engine.skills.gripper import GripperOpen, ReadGripper
from tests.robots.sim.demo_cell import LIFT, joint_state, opened_cell, part_height_m, pick, speed_rad_s


@pytest.mark.virtual
async def test_a_reopened_cell_holds_its_part_and_knows_that_it_does(tmp_path: Path) -> None:
    """Lost in the middle of a lift; the lift is then done anew."""
    async with opened_cell(tmp_path, seed=3) as cell:
        await pick(cell.bus)
        cell.bus.send_goal(LIFT, to="left")
        await cell.bus.clock.sleep(0.5)
        snapshot = await cell.snapshot()
        moving, joints, height_m = speed_rad_s(cell.bus), joint_state(cell.bus).position_rad, part_height_m(cell.bus)
    assert snapshot is not None
    assert moving > 0.1
    async with opened_cell(tmp_path, seed=3) as cell:
        await cell.restore(snapshot)
        # At rest, up to the noise of the measurement.
        assert speed_rad_s(cell.bus) < 0.005
        assert joint_state(cell.bus).position_rad == pytest.approx(joints, abs=1e-4)
        await cell.bus.clock.sleep(2.0)
        assert part_height_m(cell.bus) == pytest.approx(height_m, abs=0.002)
        assert (await cell.bus.call(ReadGripper(), to="left/gripper")).held
        assert not (await cell.bus.call(ReadGripper(), to="right/gripper")).held
        lifted = await cell.bus.send_goal(LIFT, to="left").result()
        assert (lifted.status, part_height_m(cell.bus)) == (GoalStatus.SUCCEEDED, pytest.approx(0.176, abs=0.005))
        await cell.bus.send_goal(GripperOpen(), to="left/gripper").result()
        assert not (await cell.bus.call(ReadGripper(), to="left/gripper")).held


@pytest.mark.virtual
async def test_a_cell_with_other_parts_places_refuses_the_snapshot(tmp_path: Path) -> None:
    """The seed places them."""
    async with opened_cell(tmp_path, seed=3) as cell:
        snapshot = await cell.snapshot()
    assert snapshot is not None
    async with opened_cell(tmp_path, seed=4) as cell:
        with pytest.raises(RobotError, match="open the same cell with the same seed"):
            await cell.restore(snapshot)


@pytest.mark.virtual
async def test_without_a_world_there_is_no_snapshot_and_nothing_to_restore() -> None:
    async with OpenCell(None) as cell:
        assert await cell.snapshot() is None
        with pytest.raises(CellError, match="no world to restore"):
            await cell.restore(b"")
