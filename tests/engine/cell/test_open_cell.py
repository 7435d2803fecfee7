"""An open cell is a bus: its goals end with it, its services have the time that its document gives them."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import ActiveGoal, GoalStatus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.errors import SkillFailed
from engine.messages import GripperState
from engine.skills.gripper import GraspResult, GripperFeedback, GripperOpen, ReadGripper


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


@pytest.mark.virtual
async def test_services_have_the_time_that_the_cell_gives_them(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text("flexcell: 1\ncell: bench\nbus: {service_timeout_s: 2}\n", encoding="utf-8")
    async with OpenCell(load_cell(file)) as cell:

        async def hang(_request: ReadGripper) -> GripperState:
            await cell.bus.clock.sleep(3600.0)
            raise AssertionError("the request was not cancelled")

        cell.bus.advertise_service(ReadGripper, hang, namespace="left/gripper")
        with pytest.raises(SkillFailed, match="not answered within 2 s"):
            await cell.bus.call(ReadGripper(), to="left/gripper")
        assert cell.bus.clock.now_s() == pytest.approx(2.0)
