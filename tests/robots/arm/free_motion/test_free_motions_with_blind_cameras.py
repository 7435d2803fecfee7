"""An arm does not drive into what its cameras should have seen: they are covered, and a crate stands in its way."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.skills.planning import MotionTarget, PlanMotion
from engine.skills.simulated_world import CameraFault, SetCameraFault
from tests.robots.workspace.free_cell import ACROSS, THERE, FreeCell, free, free_cell

CELL = Path(__file__).parents[2] / "workspace" / "unseen_cell.yaml"
START = (1.2, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8)


async def give(opened: FreeCell, fault: CameraFault, *cameras: str) -> None:
    """Give cameras a fault."""
    for camera in cameras:
        await opened.bus.call(SetCameraFault(camera=camera, fault=fault), to="cell")


@pytest.mark.virtual
async def test_with_both_cameras_covered_from_the_start_a_motion_is_refused_with_all_its_reasons(
    tmp_path: Path,
) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await give(opened, CameraFault(kind="covered"), "front", "side")
        before = opened.joints()
        end = await opened.send(free(ACROSS)).result()
        text = str(end.cause)
        assert end.status is GoalStatus.REJECTED
        for words in (
            "l of unknown space in bench, first at (",
            "which has never been seen",
            "camera front is covered: 100% of its pixels measure nothing",
            "camera side is covered",
            "clear the view of the cameras",
        ):
            assert words in text
        assert np.abs(opened.joints() - before).max() < 1e-3
        assert opened.touching() == ""


@pytest.mark.virtual
async def test_with_working_cameras_the_arm_goes_around_the_crate(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        touched: set[str] = set()
        end = await opened.bus.send_goal(PlanMotion(target=MotionTarget(joints=THERE)), to="left").result()
        assert end.result is not None, end.cause
        handle = opened.send(free(THERE))
        handle.on_feedback(lambda _: touched.add(opened.touching()))
        moved = await handle.result()
        assert moved.status is GoalStatus.SUCCEEDED, moved.cause
        assert touched <= {""}


@pytest.mark.virtual
async def test_an_arm_that_moves_brakes_when_a_camera_is_covered_and_goes_on_when_it_sees_again(
    tmp_path: Path,
) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        handle = opened.send(free(THERE, speed=0.1))
        await opened.until(lambda: opened.speed_rad_s() > 0.05)
        await give(opened, CameraFault(kind="covered"), "side")
        waiting = await opened.until_phase("waiting")
        assert "camera side is covered" in waiting.reason
        await give(opened, CameraFault(), "side")
        end = await handle.result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        assert opened.touching() == ""
