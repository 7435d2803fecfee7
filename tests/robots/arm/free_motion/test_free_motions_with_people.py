"""A person's arm reaches into the way of a moving arm: cameras see it, and physics counts no contact."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.skills.people import CountContacts, Reach
from tests.robots.workspace.free_cell import ACROSS, REST_RAD_S, THERE, free, free_cell

CELL = Path(__file__).parents[2] / "workspace" / "seen_cell.yaml"


@pytest.mark.virtual
async def test_a_hand_that_reaches_into_the_way_is_gone_around_without_a_contact(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS, speed=0.3))
        await opened.until(lambda: opened.speed_rad_s() > 0.2)
        await opened.bus.call(Reach(person="anna", hand_m=opened.ahead(0.65), speed_m_s=2.0), to="cell")
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops >= 1, end.result.replans >= 1) == (GoalStatus.SUCCEEDED, True, True)
        assert np.abs(opened.joints() - ACROSS).max() < 0.005
        assert any("would touch an obstacle seen by the cameras" in message.reason for message in opened.told)
        assert (await opened.bus.call(CountContacts(person="anna"), to="cell")).contacts == 0


@pytest.mark.virtual
async def test_a_hand_at_the_goal_is_waited_for_and_the_arm_goes_on_when_it_has_gone(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS, speed=0.3))
        await opened.until(lambda: opened.speed_rad_s() > 0.2)
        goal = opened.ahead(0.92)
        reach = Reach(person="anna", hand_m=goal, speed_m_s=2.0, stay_s=4.0)
        await opened.bus.call(reach, to="cell")
        await opened.until_phase("waiting")
        await opened.bus.clock.sleep(2.0)
        assert (opened.told[-1].phase, opened.speed_rad_s() < REST_RAD_S) == ("waiting", True)
        assert "an obstacle seen by the cameras" in opened.told[-1].reason
        assert (await handle.result()).status is GoalStatus.SUCCEEDED
        assert (await opened.bus.call(CountContacts(person="anna"), to="cell")).contacts == 0
