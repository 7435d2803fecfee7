"""Tests of the camera process: it sees what is there, and dies without harm."""

from __future__ import annotations

import asyncio
import os
import re
import signal
from pathlib import Path

import msgspec
import numpy as np
import pytest

from engine.cell.open_cell import OpenCell
from engine.document.cell_perception import ObjectDetector
from engine.errors import CellError, RobotError
from engine.messages import Pose
from engine.messages.sensing import NEVER_SEEN, OccupancyGrid
from engine.skills.simulated_world import CameraFault
from robots.scene.sim_scene import ArmPlacement, PartBody
from robots.sim.world.sim_world import SimWorld
from robots.vision.camera_process import CameraProcess
from robots.vision.known_geometry import KnownGeometry
from robots.vision.perception_messages import PerceptionResult, PerceptionSetup
from robots.vision.real_time_perception import RealTimePerception
from tests.robots.vision.cell_document import watched
from tests.robots.vision.watched_cell import FRONT, block, cameras, look, perception_setup, scene, voxels

WHAT = scene(block((0.5, 0.0, 0.3)))


@pytest.fixture(autouse=True)
def by_rays(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make images without graphics, which every machine can."""
    monkeypatch.setenv("FLEXCELL_DEPTH", "rays")


def alive(pid: int) -> bool:
    """Return whether a process is there."""
    return Path(f"/proc/{pid}").exists()


def test_the_process_finds_the_parts_that_it_is_asked_to_look_for() -> None:
    part = PartBody(name="cup", shape="box", size_m=(0.1, 0.1, 0.1), mass_kg=0.1, pose=Pose(xyz=(0.4, 0.1, 0.3)))
    what = scene(parts=(part,))
    seen_by = cameras(front=msgspec.structs.replace(FRONT, detect=ObjectDetector()))

    async def main() -> PerceptionResult:
        process = CameraProcess()
        await process.start(PerceptionSetup(scene=what, cameras=seen_by, box=None))
        try:
            return await process.look(msgspec.structs.replace(look(what, ()), detecting=("front",)))
        finally:
            process.end()

    seen = asyncio.run(main())
    assert (seen.grid, seen.images) == (None, ())
    (found,) = seen.detections[0].detections
    assert (found.label, found.score) == ("cup", 1.0)
    assert found.pose.xyz == pytest.approx((0.4, 0.1, 0.3), abs=1e-3)


def test_faults_conditions_and_observed_space_cross_the_process_border() -> None:
    async def main() -> tuple[PerceptionResult, PerceptionResult]:
        process = CameraProcess()
        await process.start(perception_setup(scene()))
        try:
            seen = await process.look(msgspec.structs.replace(look(scene()), observed=True))
            blind = msgspec.structs.replace(
                look(scene()), observed=True, time_s=1.5, faults={"front": CameraFault(kind="dark")}
            )
            return seen, await process.look(blind)
        finally:
            process.end()

    seen, blind = asyncio.run(main())
    assert [result.statuses[0].condition for result in (seen, blind)] == ["healthy", "dark"]
    assert seen.observed is not None
    assert blind.observed is not None
    assert min(seen.observed.ages) == 0
    # What was seen 1.5 s ago is as old, and what was not has not been shown by the dark image; around the arm all is
    # known. How much one image shows depends on the renderer.
    changed = set(zip(seen.observed.ages, blind.observed.ages, strict=True))
    assert {(0, 15), (0, 0)} <= changed <= {(0, 15), (0, 0), (NEVER_SEEN, NEVER_SEEN)}


def test_what_the_process_sees_is_what_is_there() -> None:
    async def main() -> tuple[str, int, int]:
        process = CameraProcess()
        await process.start(perception_setup(scene()))
        try:
            empty = await process.look(look(scene()))
            process.end()
            process = CameraProcess()
            await process.start(perception_setup(WHAT))
            # The block is a fixture, hence known, until told otherwise.
            process.know(KnownGeometry())
            full = await process.look(look(WHAT))
            return process.words, len(voxels(empty.grid)), len(voxels(full.grid))
        finally:
            process.end()

    words, empty, full = asyncio.run(main())
    assert words == "by ray casting, at reduced resolution"
    assert empty == 0
    assert full > 100


def test_a_killed_process_fails_the_order_and_leaves_nothing_behind() -> None:
    async def main() -> int:
        process = CameraProcess()
        await process.start(perception_setup(WHAT))
        pid = process.pid
        os.kill(pid, signal.SIGSTOP)
        answer = asyncio.ensure_future(process.look(look(WHAT)))
        await asyncio.sleep(0)
        os.kill(pid, signal.SIGKILL)
        with pytest.raises(RobotError, match="the camera process was ended by SIGKILL"):
            await answer
        with pytest.raises(RobotError, match="SIGKILL"):
            await process.look(look(WHAT))
        process.end()
        assert process.pid == 0
        return pid

    assert not alive(asyncio.run(main()))


def test_a_cell_that_cannot_be_built_is_refused_in_words() -> None:
    async def main() -> None:
        process = CameraProcess()
        nobody = ArmPlacement(name="arm", model="nobody", base=Pose(xyz=(0.0, 0.0, 0.0)))
        with pytest.raises(CellError, match="nobody"):
            await process.start(perception_setup(scene(arms=(nobody,))))
        assert process.pid == 0

    asyncio.run(main())


def test_an_order_that_makes_no_sense_is_refused_and_the_next_one_is_carried_out() -> None:
    async def main() -> int:
        process = CameraProcess()
        await process.start(perception_setup(WHAT))
        try:
            good = look(WHAT)
            for bad in (
                msgspec.structs.replace(good, state=np.zeros(0)),
                msgspec.structs.replace(good, state=np.full_like(good.state, np.nan)),
                msgspec.structs.replace(good, state=good.state[:10]),
                msgspec.structs.replace(good, cameras=("nobody",)),
            ):
                with pytest.raises(CellError):
                    await process.look(bad)
            grid = (await process.look(good)).grid
            return grid.revision if grid is not None else 0
        finally:
            process.end()

    assert asyncio.run(main()) >= 1


def test_a_watched_cell_survives_the_death_of_its_camera_process(tmp_path: Path) -> None:
    async def main() -> None:
        async with OpenCell(watched(tmp_path)) as cell:
            assert isinstance(cell.world, SimWorld)
            (cameras,) = (device for device in cell.world.devices() if isinstance(device, RealTimePerception))
            changed = asyncio.Event()
            cameras.subscribe(changed.set)
            cameras.require()

            async def until(reason: str) -> None:
                while not re.fullmatch(reason, cameras.stale_reason):
                    changed.clear()
                    await asyncio.wait_for(changed.wait(), 60.0)

            await until("")
            before, pid = cameras.latest, cameras.pid
            # One that hangs makes the map old; images that it missed are not made up for.
            os.kill(pid, signal.SIGSTOP)
            await until("the latest image is .* old")
            os.kill(pid, signal.SIGCONT)
            await until("")
            assert cameras.pid == pid
            os.kill(pid, signal.SIGKILL)
            await until(r"the camera process was ended by SIGKILL \(a new one is started\)")
            await until("")
            after = cameras.latest
            assert cameras.pid not in (0, pid)
            assert before is not None
            assert after is not None
            assert after.revision > before.revision
            assert after.time_s > before.time_s
            assert cell.bus.topic("cell/occupancy", OccupancyGrid).count >= 2
            last = cameras.pid
        assert not alive(last)

    asyncio.run(main())
