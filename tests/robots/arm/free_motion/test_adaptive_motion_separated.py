"""A motion that separation monitoring makes creep or stand says by whom, takes another path, or waits for its turn."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import GoalStatus
from engine.messages.separation import SeparationState
from engine.skills.people import CountContacts, Reach
from engine.skills.planning import FreeMotionFeedback, MotionTarget, MoveFree, PlanOptions
from robots.workspace.monitored_separation import MonitoredSeparation
from tests.robots.workspace.fake_cell import FakeCell, fake_cell
from tests.robots.workspace.free_cell import ACROSS, THERE, free
from tests.robots.workspace.test_separation_supervisor import GOAL, START, opened_cell

NEAR_THE_GOAL = (0.35, 0.3, 0.45)
REST_M, CREEP_M = 0.1, 0.23
HAND = ((0.1, -0.05, 0.5), (0.15, 0.05, 0.6))
"""Beside the direct path from THERE to ACROSS, seen by the cameras."""
AT_THE_GOAL = ((-0.3, -0.6, 0.4), (-0.1, -0.5, 0.7))
"""Beside ACROSS: no path there keeps away from it."""

pytestmark = pytest.mark.virtual


async def test_when_who_stayed_near_leaves_the_arm_goes_on(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        assert (await cell.move(START).result()).status is GoalStatus.SUCCEEDED
        goal = MoveFree(target=MotionTarget(joints=GOAL), options=PlanOptions(speed=0.4))
        handle = cell.bus.send_goal(goal, to="left")
        told: list[FreeMotionFeedback] = []
        handle.on_feedback(told.append)
        await cell.until(lambda: cell.speed_rad_s > 0.2)
        await cell.bus.call(Reach(person="anna", hand_m=NEAR_THE_GOAL, speed_m_s=1.2, stay_s=4.0), to="cell")
        await cell.until(lambda: told[-1].phase == "waiting")
        assert "m from left/panda_" in told[-1].reason
        assert "separation monitoring permits hardly any motion there" in told[-1].reason
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops, end.result.waited_s > 1.0) == (GoalStatus.SUCCEEDED, 1, True)
        assert (await cell.bus.call(CountContacts(person="anna"), to="cell")).contacts == 0


async def _creeps(cell: FakeCell, separation: MonitoredSeparation, *, distance_m: float, for_s: float = 1.3) -> None:
    """Let separation monitoring report for a while that hardly any speed is permitted."""
    for _ in range(round(for_s / 0.02)):
        time_s = cell.bus.clock.now_s()
        state = SeparationState(
            time_s=time_s, monitoring=True, distance_m=distance_m, nearest="left/panda_hand", permitted_share=0.08
        )
        separation.record("left", state)
        await cell.bus.clock.sleep(0.02)


async def test_an_arm_that_creeps_past_somebody_takes_a_path_that_keeps_away() -> None:
    separation = MonitoredSeparation(REST_M)
    async with fake_cell(separation=separation) as cell:
        await cell.bus.send_goal(free(THERE), to="left").result()
        cell.cameras.see(HAND)
        handle = await cell.begun(free(ACROSS, speed=0.05), after_s=0.1)
        first = len(cell.port.followed)
        await _creeps(cell, separation, distance_m=CREEP_M)
        separation.record("left", SeparationState(time_s=cell.bus.clock.now_s(), monitoring=True, distance_m=1.0))
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops, end.result.replans) == (GoalStatus.SUCCEEDED, 1, 1)
        assert len(cell.port.followed) == first + 1
        assert any("separation monitoring permits hardly any motion" in message.reason for message in cell.told)


async def test_where_no_path_keeps_away_the_arm_creeps_on_along_its_own() -> None:
    separation = MonitoredSeparation(REST_M)
    async with fake_cell(separation=separation) as cell:
        await cell.bus.send_goal(free(THERE), to="left").result()
        cell.cameras.see(AT_THE_GOAL)
        handle = await cell.begun(free(ACROSS, speed=0.05), after_s=0.1)
        await _creeps(cell, separation, distance_m=CREEP_M)
        assert any("separation monitoring" in message.reason for message in cell.told)
        while not cell.moves():
            await cell.bus.clock.sleep(0.02)
        separation.record("left", SeparationState(time_s=cell.bus.clock.now_s(), monitoring=True, distance_m=1.0))
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops, end.result.replans, end.result.reused) == (GoalStatus.SUCCEEDED, 1, 0, 1)


async def test_who_stays_is_waited_for_until_the_patience_is_over() -> None:
    separation = MonitoredSeparation(REST_M)
    async with fake_cell(separation=separation) as cell:
        await cell.bus.send_goal(free(THERE), to="left").result()
        handle = await cell.begun(free(ACROSS, speed=0.05, patience_s=3.0), after_s=0.1)
        await _creeps(cell, separation, distance_m=REST_M - 0.02, for_s=5.0)
        end = await handle.result()
        assert (end.status, cell.told[-1].phase) == (GoalStatus.ABORTED, "waiting")
        waited = "no path is free for 3 s: an obstacle seen by the cameras is 0.08 m from left/panda_hand"
        assert waited in str(end.cause)


async def test_an_arm_that_creeps_for_long_looks_for_another_path_ever_more_rarely() -> None:
    separation = MonitoredSeparation(REST_M)
    async with fake_cell(separation=separation) as cell:
        await cell.bus.send_goal(free(THERE), to="left").result()
        cell.cameras.see(HAND)
        handle = await cell.begun(free(ACROSS, speed=0.02), after_s=0.1)
        await _creeps(cell, separation, distance_m=CREEP_M, for_s=20.0)
        separation.record("left", SeparationState(time_s=cell.bus.clock.now_s(), monitoring=True, distance_m=1.0))
        end = await handle.result()
        assert end.result is not None, end.cause
        assert end.status is GoalStatus.SUCCEEDED
        assert 2 <= end.result.stops <= 4
