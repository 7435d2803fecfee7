"""A motion that waits for its first path, or follows a new one, tells and is monitored as on any path."""

from __future__ import annotations

import pytest

from engine.bus import GoalStatus
from engine.skills.planning_scene import PutObstacle
from tests.robots.workspace.fake_cell import fake_cell
from tests.robots.workspace.free_cell import ACROSS, THERE, box, free

HAND = ((-0.1, 0.05, 0.1), (0.0, 0.15, 0.75))
"""In the way from THERE to ACROSS, seen by the cameras."""
BODY = ((-0.3, -0.36, 0.4), (-0.1, -0.2, 0.7))
"""Somebody who stands where the tool is to go, ACROSS."""
FAR = box("shelf", (0.1, 0.1, 0.1), (1.5, 1.5, 0.05))


@pytest.mark.virtual
async def test_a_change_that_is_not_in_its_way_does_not_stop_an_arm_on_a_new_path() -> None:
    async with fake_cell() as cell:
        end = await cell.bus.send_goal(free(THERE), to="left").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        handle = await cell.begun(free(ACROSS))
        first = len(cell.port.followed)
        cell.cameras.see(HAND)
        while len(cell.port.followed) == first:
            await cell.bus.clock.sleep(0.01)
        await cell.bus.clock.sleep(0.05)
        assert cell.moves()
        # As long as the check takes the arm moves on.
        cell.planner.silent_s = 0.1
        await cell.bus.call(PutObstacle(obstacle=FAR), to="cell")
        await cell.bus.clock.sleep(0.05)
        assert cell.moves()
        cell.planner.silent_s = 0.0
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops, end.result.replans) == (GoalStatus.SUCCEEDED, 1, 1)


@pytest.mark.virtual
async def test_a_motion_that_waits_for_its_first_path_has_made_no_progress() -> None:
    async with fake_cell() as cell:
        end = await cell.bus.send_goal(free(THERE), to="left").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        cell.cameras.see(BODY)
        handle = await cell.begun(free(ACROSS, time_s=0.2), after_s=2.0)
        assert {message.progress for message in cell.told} == {0.0}
        cell.cameras.see()
        assert (await handle.result()).status is GoalStatus.SUCCEEDED
        assert cell.told[-1].progress > 0.9
