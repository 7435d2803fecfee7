"""Each fault of a simulated camera is noticed, named on its status topic, and ends when the fault ends."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.errors import SkillFailed
from engine.messages.sensing import NEVER_SEEN, CameraStatus, ObservedSpace
from engine.skills.motion import JointTrapVel
from engine.skills.simulated_world import CameraFault, SetCameraFault
from tests.robots.vision.cell_document import watched
from tests.robots.vision.test_lockstep_perception_occupancy import cameras_of

FAULTS = {
    "covered": (CameraFault(kind="covered"), "covered", "100% of its pixels measure nothing"),
    "cloth": (CameraFault(kind="covered", cover_m=0.3), "covered", "a surface at 0.30 m hides everything"),
    "dark": (CameraFault(kind="dark"), "dark", "mean brightness of its image is 0.00"),
    "late": (CameraFault(kind="late", delay_s=1.0), "late", "s old, more than 0.30 s"),
    "lifted": (CameraFault(kind="displaced", offset_m=(0.0, 0.0, 0.15)), "displaced", "before they agreed"),
    "lowered": (CameraFault(kind="displaced", offset_m=(0.0, 0.0, -0.15)), "displaced", "nearer by 0.15 m"),
    "turned": (CameraFault(kind="displaced", turn_rad=(0.15, 0.0, 0.0)), "displaced", "before they agreed"),
}


def status_of(cell: OpenCell, camera: str = "top") -> CameraStatus:
    """Return the status of a camera on the bus."""
    status = cell.bus.topic(f"{camera}/status", CameraStatus).latest
    assert status is not None
    return status


async def give(cell: OpenCell, fault: CameraFault, camera: str = "top") -> None:
    """Give a camera a fault."""
    await cell.bus.call(SetCameraFault(camera=camera, fault=fault), to="cell")


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_named_with_its_figures_and_ends(tmp_path: Path, name: str) -> None:
    fault, condition, cause = FAULTS[name]

    async def main() -> None:
        async with OpenCell(watched(tmp_path)) as cell:
            cameras = cameras_of(cell)
            assert status_of(cell).condition == "unknown"
            cameras.require()
            await asyncio.sleep(1.0)
            assert (status_of(cell).condition, status_of(cell, "side").condition) == ("healthy", "healthy")
            await give(cell, fault)
            await asyncio.sleep(1.0)
            found = status_of(cell)
            assert (found.condition, cause in found.cause) == (condition, True), found
            assert status_of(cell, "side").condition == "healthy"
            await give(cell, CameraFault())
            await asyncio.sleep(1.0)
            assert status_of(cell).condition == "healthy"

    run_virtual(main())


def test_a_wrong_focal_length_is_a_wrong_calibration_from_the_first_image_on(tmp_path: Path) -> None:
    async def main() -> CameraStatus:
        async with OpenCell(watched(tmp_path)) as cell:
            await give(cell, CameraFault(kind="miscalibrated", focal_scale=1.4))
            cameras_of(cell).require()
            await asyncio.sleep(0.25)
            return status_of(cell)

    status = run_virtual(main())
    assert (status.condition, "they have never agreed" in status.cause) == ("miscalibrated", True), status


def test_equal_images_of_a_camera_with_noise_are_frozen(tmp_path: Path) -> None:
    async def main() -> CameraStatus:
        async with OpenCell(watched(tmp_path)) as cell:
            cameras_of(cell).require()
            await asyncio.sleep(0.5)
            await give(cell, CameraFault(kind="frozen"))
            await asyncio.sleep(0.6)
            return status_of(cell)

    status = run_virtual(main())
    assert (status.condition, "each has its own noise" in status.cause) == ("frozen", True), status


def test_equal_images_of_a_camera_without_noise_are_frozen_once_the_arm_has_moved(tmp_path: Path) -> None:
    async def main() -> tuple[str, CameraStatus]:
        async with OpenCell(watched(tmp_path)) as cell:
            cameras_of(cell).require()
            await asyncio.sleep(0.5)
            await give(cell, CameraFault(kind="frozen"), "side")
            await asyncio.sleep(1.0)
            at_rest = status_of(cell, "side").condition
            await cell.bus.send_goal(JointTrapVel(joints=(2.6, -1.5), speed=0.5), to="arm").result()
            await asyncio.sleep(0.5)
            return at_rest, status_of(cell, "side")

    at_rest, status = run_virtual(main())
    assert at_rest == "healthy"
    assert (status.condition, "an arm has moved" in status.cause) == ("frozen", True), status


def test_images_that_move_with_the_arm_are_healthy(tmp_path: Path) -> None:
    async def main() -> set[str]:
        heard: set[str] = set()
        async with OpenCell(watched(tmp_path)) as cell:
            for camera in ("top", "side"):
                cell.bus.topic(f"{camera}/status", CameraStatus).subscribe(lambda status: heard.add(status.condition))
            cameras_of(cell).require()
            await asyncio.sleep(0.5)
            for joints in ((2.6, -1.5), (0.3, 0.4), (0.0, 0.0)):
                await cell.bus.send_goal(JointTrapVel(joints=joints, speed=0.8), to="arm").result()
        return heard

    assert run_virtual(main()) == {"healthy"}


def test_a_covered_camera_neither_fills_nor_frees(tmp_path: Path) -> None:
    async def main() -> tuple[bytes, set[int]]:
        async with OpenCell(watched(tmp_path)) as cell:
            cameras = cameras_of(cell)
            for camera in ("top", "side"):
                await give(cell, CameraFault(kind="covered", cover_m=0.3), camera)
            cell.bus.topic("cell/observed_space", ObservedSpace).subscribe(lambda _: None)
            await asyncio.sleep(1.0)
            assert cameras.latest is not None
            assert cameras.observed is not None
            return cameras.latest.occupied, set(cameras.observed.ages)

    occupied, ages = run_virtual(main())
    assert (any(occupied), ages) == (False, {0, NEVER_SEEN})


def test_a_fault_of_an_unknown_camera_is_refused(tmp_path: Path) -> None:
    async def main() -> None:
        async with OpenCell(watched(tmp_path)) as cell:
            with pytest.raises(SkillFailed, match=r"there is no camera tap \(did you mean top"):
                await give(cell, CameraFault(kind="dark"), "tap")

    run_virtual(main())
