"""A person's arm reaches into the way of a moving arm: cameras see it, and physics counts no contact."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.skills.people import CountContacts, Reach
from tests.robots.workspace.free_cell import ACROSS, REST_RAD_S, THERE, box, free, free_cell

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


@pytest.mark.virtual
async def test_an_arm_does_not_start_again_while_a_hand_comes_near(tmp_path: Path) -> None:
    """Its path gets free while the hand is on its way, a quarter of a second off: it is met by an arm at rest."""
    async with free_cell(tmp_path, cell=CELL) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS, speed=0.3))
        await opened.until(lambda: opened.joints()[0] < 0.35)
        await opened.put(box("wall", (1.5, 0.02, 2.6), (-0.05, -0.3, 1.0)))
        await opened.until_phase("waiting")
        x, y, z = opened.tool_xyz()
        reach = Reach(person="anna", hand_m=(x + 0.03, y, z), speed_m_s=1.6, stay_s=1.0)
        arrives_s = opened.bus.clock.now_s() + (await opened.bus.call(reach, to="cell")).arrives_in_s
        await opened.bus.clock.sleep(0.5)
        await opened.remove("wall")
        fastest, contacts = 0.0, 0
        while not contacts and opened.bus.clock.now_s() < arrives_s:
            fastest = max(fastest, opened.speed_rad_s())
            await opened.bus.clock.sleep(0.005)
            contacts = (await opened.bus.call(CountContacts(person="anna"), to="cell")).contacts
        assert contacts > 0
        assert fastest < REST_RAD_S
        assert any("comes within 40 cm of the arm" in message.reason for message in opened.told)
        assert (await handle.result()).status is GoalStatus.SUCCEEDED
