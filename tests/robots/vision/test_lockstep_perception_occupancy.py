"""Tests of the cameras in virtual time: images only while needed, the map later by the processing, twice the same."""

from __future__ import annotations

import asyncio
from pathlib import Path

import msgspec
import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.errors import CellError
from engine.messages import Pose
from engine.messages.sensing import CameraInfo, DepthImage, OccupancyGrid, OccupancyState
from engine.messages.shapes import Box, Obstacle
from engine.skills.people import Reach
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene
from robots.sim.host.lockstep_host import LockstepHost
from robots.sim.host.world_host import WorldListener
from robots.sim.world.sim_world import SimWorld
from robots.vision.lockstep_perception import LockstepPerception
from robots.vision.perception_device import PROCESSING_S
from tests.robots.vision.cell_document import watched
from tests.robots.vision.watched_cell import voxels


def cameras_of(cell: OpenCell) -> LockstepPerception:
    """Return the cameras of an open cell."""
    assert isinstance(cell.world, SimWorld)
    (found,) = (device for device in cell.world.devices() if isinstance(device, LockstepPerception))
    return found


def state_of(cell: OpenCell) -> OccupancyState:
    """Return what the cell says of its map."""
    state = cell.bus.topic("cell/occupancy_state", OccupancyState).latest
    assert state is not None
    return state


async def reach(cell: OpenCell, x: float, y: float, z: float) -> None:
    """Let the person's hand go somewhere."""
    await cell.bus.call(Reach(person="anna", hand_m=(x, y, z), speed_m_s=1.0), to="cell")


def test_no_image_is_taken_while_nobody_needs_one(tmp_path: Path) -> None:
    async def main() -> tuple[int, int, int]:
        async with OpenCell(watched(tmp_path)) as cell:
            cameras = cameras_of(cell)
            await asyncio.sleep(1.0)
            before = state_of(cell).looks
            cameras.require()
            await asyncio.sleep(1.0)
            cameras.release()
            needed = state_of(cell).looks
            await asyncio.sleep(1.0)
            return before, needed, state_of(cell).looks

    before, needed, after = run_virtual(main())
    assert before == 0
    assert needed in (9, 10)
    assert after - needed <= 1


def test_the_map_comes_after_the_image_by_the_processing_time(tmp_path: Path) -> None:
    async def main() -> list[tuple[float, float]]:
        heard: list[tuple[float, float]] = []
        async with OpenCell(watched(tmp_path)) as cell:
            grids = cell.bus.topic("cell/occupancy", OccupancyGrid)
            world = cell.world
            assert isinstance(world, SimWorld)
            grids.subscribe(lambda grid: heard.append((grid.time_s, world.measured().time_s)))
            await asyncio.sleep(0.5)
        return heard

    heard = run_virtual(main())
    assert heard
    assert [told - taken for taken, told in heard] == pytest.approx([PROCESSING_S] * len(heard), abs=1e-6)


def test_a_persons_arm_is_in_the_map_and_gone_when_it_is_gone(tmp_path: Path) -> None:
    async def main() -> list[int]:
        counts: list[int] = []
        async with OpenCell(watched(tmp_path)) as cell:
            cameras = cameras_of(cell)
            cameras.require()
            await asyncio.sleep(0.5)
            for x, y in ((0.5, 0.0), (0.95, 0.45)):
                await reach(cell, x, y, 0.3)
                await asyncio.sleep(2.5)
                assert cameras.latest is not None
                near = voxels(cameras.latest)
                counts.append(int((abs(near - (0.5, 0.0, 0.3)) < 0.06).all(axis=1).sum()))
        return counts

    reached, gone = run_virtual(main())
    assert reached > 10
    assert gone == 0


def test_the_map_of_a_lost_world_is_not_trusted_until_the_world_is_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Images of a world that does not step any more would look like a cell at rest."""
    listeners: list[WorldListener] = []
    original = LockstepHost.open

    async def heard(self: LockstepHost, listener: WorldListener) -> None:
        listeners.append(listener)
        await original(self, listener)

    monkeypatch.setattr(LockstepHost, "open", heard)

    async def main() -> list[str]:
        async with OpenCell(watched(tmp_path)) as cell:
            cameras = cameras_of(cell)
            cameras.require()
            await asyncio.sleep(0.5)
            reasons = [cameras.stale_reason]
            listeners[0].lost("the world's process was ended by SIGKILL")
            await asyncio.sleep(0.5)
            reasons.append(cameras.stale_reason)
            await cell.reconnect()
            await asyncio.sleep(0.5)
            return [*reasons, cameras.stale_reason]

    before, lost, after = run_virtual(main())
    assert (before, after) == ("", "")
    assert "SIGKILL" in lost


def test_two_runs_see_the_same_bytes(tmp_path: Path) -> None:
    async def main() -> list[bytes]:
        heard: list[bytes] = []
        async with OpenCell(watched(tmp_path), seed=4) as cell:
            keep = heard.append
            cell.bus.topic("cell/occupancy", OccupancyGrid).subscribe(lambda m: keep(msgspec.msgpack.encode(m)))
            cell.bus.topic("top/depth", DepthImage).subscribe(lambda m: keep(msgspec.msgpack.encode(m)))
            await reach(cell, 0.5, 0.0, 0.3)
            await asyncio.sleep(1.5)
        return heard

    first = run_virtual(main())
    assert len(first) > 15
    assert run_virtual(main()) == first


def test_images_come_to_who_reads_them(tmp_path: Path) -> None:
    async def main() -> tuple[list[DepthImage], CameraInfo | None]:
        images: list[DepthImage] = []
        async with OpenCell(watched(tmp_path)) as cell:
            cell.bus.topic("side/depth", DepthImage).subscribe(images.append)
            await asyncio.sleep(1.0)
            return images, cell.bus.topic("side/camera_info", CameraInfo).latest

    images, info = run_virtual(main())
    assert [image.time_s for image in images] == pytest.approx([0.2, 0.4, 0.6, 0.8])
    assert info is not None
    assert info.rate_hz == 5.0
    assert {image.pose for image in images} == {info.pose}


def test_the_map_is_stale_before_the_first_image_and_long_after_the_last(tmp_path: Path) -> None:
    async def main() -> list[str]:
        reasons: list[str] = []
        calls: list[str] = []
        async with OpenCell(watched(tmp_path)) as cell:
            cameras = cameras_of(cell)
            unsubscribe = cameras.subscribe(lambda: calls.append(cameras.stale_reason))
            cameras.require()
            reasons.append(cameras.stale_reason)
            await asyncio.sleep(0.5)
            reasons.append(cameras.stale_reason)
            cameras.release()
            await asyncio.sleep(3.0)
            reasons.append(cameras.stale_reason)
            cameras.require()
            await asyncio.sleep(0.5)
            reasons.append(cameras.stale_reason)
            unsubscribe()
            assert calls[0] == ""
        return reasons

    first, seeing, later, again = run_virtual(main())
    assert first == "no camera image yet"
    assert later.startswith("the latest image is 3")
    assert (seeing, again) == ("", "")


def test_forgetting_begins_anew_with_the_next_image(tmp_path: Path) -> None:
    async def main() -> tuple[OccupancyGrid | None, OccupancyGrid | None, OccupancyGrid | None]:
        async with OpenCell(watched(tmp_path)) as cell:
            cameras = cameras_of(cell)
            cameras.require()
            await reach(cell, 0.5, 0.0, 0.3)
            await asyncio.sleep(4.0)
            before = cameras.latest
            cameras.forget()
            at_once = cameras.latest
            await asyncio.sleep(0.5)
            return before, at_once, cameras.latest

    before, at_once, after = run_virtual(main())
    assert before is not None
    assert at_once == before
    # What is still there is seen again, by one image.
    assert after is not None
    assert after.revision > before.revision
    assert len(voxels(after)) > 0.6 * len(voxels(before))


def test_an_earlier_state_of_the_world_makes_the_map_stale(tmp_path: Path) -> None:
    async def main() -> tuple[str, str]:
        async with OpenCell(watched(tmp_path)) as cell:
            cameras = cameras_of(cell)
            cameras.require()
            snapshot = await cell.snapshot()
            await asyncio.sleep(1.0)
            assert snapshot is not None
            await cell.restore(snapshot)
            restored = cameras.stale_reason
            await asyncio.sleep(0.5)
            return restored, cameras.stale_reason

    restored, later = run_virtual(main())
    assert "restored to an earlier state" in restored
    assert later == ""


def test_what_cannot_be_mapped_makes_the_map_stale_in_words_until_it_is_put_right(tmp_path: Path) -> None:
    async def main() -> tuple[str, str]:
        async with OpenCell(watched(tmp_path)) as cell:
            cameras = cameras_of(cell)
            cameras.require()
            floor = Obstacle.of("floor", Box(size_m=(2.6, 2.6, 0.04)), Pose(xyz=(0.3, 0.0, -0.02)))
            held = AttachedPart(name="pen", arm="arm", link="nose", solids=floor.solids)
            cameras.know(PlanningScene(obstacles=(floor,), attached=(held,)))
            await asyncio.sleep(0.5)
            wrong = cameras.stale_reason
            cameras.know(PlanningScene(obstacles=(floor,)))
            await asyncio.sleep(0.5)
            return wrong, cameras.stale_reason

    assert run_virtual(main()) == ("arm: the arm has no link nose (name a link of the URDF)", "")


def test_an_unknown_wish_for_images_is_refused_when_the_cell_is_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FLEXCELL_DEPTH", "magic")

    async def main() -> None:
        with pytest.raises(CellError, match="FLEXCELL_DEPTH is magic"):
            async with OpenCell(watched(tmp_path)):
                pass

    run_virtual(main())
