"""An arm does not drive into what its cameras should have seen: they are covered, and a crate stands in its way."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import JointTrapVel
from engine.skills.simulated_world import CameraFault, SetCameraFault
from tests.robots.workspace.free_cell import ACROSS, THERE, FreeCell, free, free_cell

CELL = Path(__file__).parents[2] / "workspace" / "unseen_cell.yaml"


async def give(opened: FreeCell, fault: CameraFault, *cameras: str) -> None:
    """Give cameras a fault."""
    for camera in cameras:
        await opened.bus.call(SetCameraFault(camera=camera, fault=fault), to="cell")


async def drive(opened: FreeCell, joints: tuple[float, ...]) -> str:
    """Move blindly until the arm touches something or is there; return what it touches."""
    blind = JointTrapVel(joints=joints, speed=0.3, collisions=CollisionOptions(avoid=False))
    handle = opened.bus.send_goal(blind, to="left")
    await opened.until(lambda: bool(opened.touching()) or np.abs(opened.joints() - joints).max() < 0.01)
    touched = opened.touching()
    if touched:
        handle.cancel()
    await handle.result()
    return touched


@pytest.mark.virtual
async def test_with_both_cameras_covered_from_the_start_a_motion_is_refused_with_all_its_reasons(
    tmp_path: Path,
) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await give(opened, CameraFault(kind="covered"), "front", "side")
        assert await drive(opened, THERE) == ""
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
        # So is one that is not planned.
        end = await opened.bus.send_goal(JointTrapVel(joints=ACROSS, speed=0.3), to="left").result()
        assert end.status is GoalStatus.REJECTED
        assert "l of unknown space in bench, first at (" in str(end.cause)
        assert np.abs(opened.joints() - before).max() < 1e-3
        # The refused motions lead into the crate.
        assert "crate" in await drive(opened, ACROSS)


@pytest.mark.virtual
async def test_with_working_cameras_the_arm_goes_around_the_crate(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        assert await drive(opened, THERE) == ""
        handle = opened.send(free(ACROSS, speed=0.3, margin_m=0.02))
        touched: set[str] = set()

        def is_there() -> bool:
            touched.add(opened.touching())
            return bool(np.abs(opened.joints() - ACROSS).max() < 0.01)

        await opened.until(is_there, within_s=30.0)
        end = await handle.result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        assert touched == {""}


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


@pytest.mark.virtual
async def test_a_motion_that_is_not_planned_is_refused_where_the_cameras_see_the_crate(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        assert await drive(opened, THERE) == ""
        before = opened.joints()
        end = await opened.bus.send_goal(JointTrapVel(joints=ACROSS, speed=0.3), to="left").result()
        assert (end.status, opened.touching()) == (GoalStatus.REJECTED, "")
        assert "would touch an obstacle seen by the cameras" in str(end.cause)
        assert np.abs(opened.joints() - before).max() < 1e-3
