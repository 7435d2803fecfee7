"""A motion that has not begun when its arm is lost does not begin once the arm is found again."""

from __future__ import annotations

import pytest

from engine.bus import GoalStatus
from engine.cause_chain import describe_cause
from tests.robots.workspace.fake_cell import FakeCell, fake_cell
from tests.robots.workspace.free_cell import ACROSS, THERE, free

LOST = "the world is lost"
pytestmark = pytest.mark.virtual


async def _waiting_cell(cell: FakeCell) -> None:
    """Let the cameras see somebody at the goal ACROSS, the arm at THERE."""
    cell.port.lead_to(THERE)
    # Both hands of a person around the place of the tool at the goal.
    cell.cameras.see(((-0.4, -0.6, 0.2), (0.1, -0.1, 0.8)))


@pytest.mark.parametrize("lost_s", [0.1, 1.0])
async def test_an_arm_that_was_lost_while_it_waited_for_its_first_path_stays_where_it_is(lost_s: float) -> None:
    async with fake_cell() as cell:
        await _waiting_cell(cell)
        handle = await cell.begun(free(ACROSS, patience_s=60.0), after_s=1.0)
        assert cell.port.followed == []
        assert cell.told[-1].phase == "waiting"
        cell.arm.world_lost(LOST)
        await cell.bus.clock.sleep(lost_s)
        cell.arm.world_restored()
        cell.cameras.see()
        end = await handle.result()
        assert cell.port.followed == []
        assert end.cause is not None
        assert (end.status, "lost" in describe_cause(end.cause)) == (GoalStatus.ABORTED, True), describe_cause(
            end.cause
        )
        # The next goal moves it.
        assert (await cell.bus.send_goal(free(ACROSS), to="left").result()).status is GoalStatus.SUCCEEDED


async def test_a_path_that_was_planned_before_the_arm_was_lost_is_not_followed_afterwards() -> None:
    async with fake_cell() as cell:
        cell.port.lead_to(THERE)
        cell.planner.silent_s = 1.0
        handle = cell.bus.send_goal(free(ACROSS), to="left")
        await cell.bus.clock.sleep(0.5)
        cell.arm.world_lost(LOST)
        cell.arm.world_restored()
        end = await handle.result()
        assert (end.status, cell.port.followed) == (GoalStatus.REJECTED, [])
        assert "stopped or lost during planning" in str(end.cause)
