"""An open cell without a document is a bus, whose goals end with it like those of any cell."""

from __future__ import annotations

import pytest

from engine.bus import ActiveGoal, GoalStatus
from engine.cell.open_cell import OpenCell
from engine.skills.gripper import GraspResult, GripperFeedback, GripperOpen


@pytest.mark.virtual
async def test_goals_on_a_bus_without_a_cell_end_when_it_closes() -> None:
    cancelled: list[str] = []
    async with OpenCell(None) as cell:

        async def wait(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
            handle.accept()
            handle.on_cancel(lambda: cancelled.append("cancelled"))
            while not handle.cancel_requested:
                await cell.bus.clock.sleep(0.1)
            return GraspResult(held=False, width_m=0.0, force_n=0.0)

        cell.bus.advertise_action(GripperOpen, wait, namespace="left/gripper", exclusive="left/gripper")
        goal = cell.bus.send_goal(GripperOpen(), to="left/gripper")
        await goal.accepted()
    assert cancelled == ["cancelled"]
    assert (await goal.result()).status is GoalStatus.CANCELED
