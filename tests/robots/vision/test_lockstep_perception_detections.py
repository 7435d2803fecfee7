"""The detectors of a cell in virtual time: asked, read or always on, the same twice, and true to what happens."""

from __future__ import annotations

import asyncio
from itertools import pairwise
from pathlib import Path

import msgspec
import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import Cell, load_cell
from engine.errors import BusError, CellError, DocumentError, SkillFailed
from engine.messages.sensing import DepthImage
from engine.skills.vision import Detections, DetectObjects
from robots.sim.world.sim_world import SimWorld
from robots.vision.lockstep_perception import LockstepPerception
from robots.vision.perception_device import PROCESSING_S

_TEXT = """
flexcell: 1
cell: seen
world: {kind: mujoco, step_s: 0.002}
fixtures:
  floor: {shape: box, size_m: [2.6, 2.6, 0.04], at: {xyz: [0.3, 0, -0.02]}}
parts:
  cube: {shape: box, size_m: [0.05, 0.05, 0.05], mass_kg: 0.1, at: {xyz: [0.4, 0.2, HEIGHT]}}
  ball: {shape: sphere, size_m: [0.04], mass_kg: 0.1, at: {xyz: [0.5, -0.2, 0.02]}}
cameras:
  top: {at: [0.4, 0.0, 1.8], look_at: [0.4, 0, 0.1], fov_rad: 1.2, rate_hz: 20, detect: DETECT}
  side: {at: [0.4, 1.2, 1.2], look_at: [0.4, 0, 0.1], rate_hz: 5}
MORE
"""


def cell_with(folder: Path, *, detect: str = "{}", height: float = 0.025, more: str = "") -> Cell:
    """Return a cell with a camera that detects, written to a folder."""
    text = _TEXT.replace("DETECT", detect).replace("HEIGHT", str(height)).replace("MORE", more)
    file = folder / "seen.yaml"
    file.write_text(text, encoding="utf-8")
    return load_cell(file)


def now_s(cell: OpenCell) -> float:
    """Return the time of the world."""
    assert isinstance(cell.world, SimWorld)
    return cell.world.measured().time_s


def test_who_asks_gets_what_is_in_the_next_image(tmp_path: Path) -> None:
    async def main() -> tuple[Detections, Detections, float, float]:
        async with OpenCell(cell_with(tmp_path)) as cell:
            await asyncio.sleep(0.51)
            asked_s = now_s(cell)
            every = await cell.bus.call(DetectObjects(), to="top")
            answered_s = now_s(cell)
            balls = await cell.bus.call(DetectObjects(labels=("ball",), minimal_score=0.9), to="top")
            return every, balls, asked_s, answered_s

    every, balls, asked_s, answered_s = run_virtual(main())
    assert {each.label for each in every.detections} == {"cube", "ball"}
    assert [each.label for each in balls.detections] == ["ball"]
    assert asked_s <= every.time_s <= asked_s + 0.05
    assert answered_s - every.time_s == pytest.approx(PROCESSING_S, abs=1e-6)
    cube = next(each for each in every.detections if each.label == "cube")
    assert cube.pose.xyz == pytest.approx((0.4, 0.2, 0.025), abs=1e-3)


def test_nothing_is_looked_for_while_nobody_wants_to_know(tmp_path: Path) -> None:
    async def main() -> list[float]:
        heard: list[float] = []
        async with OpenCell(cell_with(tmp_path)) as cell:
            topic = cell.bus.topic("top/detections", Detections)
            await asyncio.sleep(1.0)
            before = topic.count
            reader = topic.subscribe(lambda message: heard.append(message.time_s))
            await asyncio.sleep(1.0)
            reader.close()
            await asyncio.sleep(0.1)
            read = topic.count
            await asyncio.sleep(1.0)
            assert (before, topic.count) == (0, read)
        return heard

    heard = run_virtual(main())
    # Four times a second by default.
    assert [after - before for before, after in pairwise(heard)] == pytest.approx([0.25] * 3)


def test_the_parameters_switch_it_on_and_say_how_often(tmp_path: Path) -> None:
    async def main() -> tuple[int, int, int]:
        async with OpenCell(cell_with(tmp_path, detect="{always: true, rate_hz: 2}")) as cell:
            topic = cell.bus.topic("top/detections", Detections)
            await asyncio.sleep(2.0)
            always = topic.count
            cell.bus.parameters.set("top/detection_rate_hz", 10)
            await asyncio.sleep(2.0)
            often = topic.count - always
            with pytest.raises(BusError):
                cell.bus.parameters.set("top/detection_rate_hz", 0)
            cell.bus.parameters.set("top/detect_always", False)
            await asyncio.sleep(0.1)
            off = topic.count
            await asyncio.sleep(1.0)
            return always, often, topic.count - off

    always, often, off = run_virtual(main())
    assert always == pytest.approx(4, abs=1)
    assert often == pytest.approx(20, abs=1)
    assert off == 0


def test_a_part_that_drops_drops_in_the_detections(tmp_path: Path) -> None:
    async def main() -> list[tuple[float, float]]:
        heard: list[tuple[float, float]] = []

        def keep(message: Detections) -> None:
            heights = [each.pose.xyz[2] for each in message.detections if each.label == "cube"]
            heard.extend((message.time_s, height) for height in heights)

        async with OpenCell(cell_with(tmp_path, height=0.6, detect="{rate_hz: 20}")) as cell:
            cell.bus.topic("top/detections", Detections).subscribe(keep)
            await asyncio.sleep(1.5)
        return heard

    heard = run_virtual(main())
    falling = [(time_s, height) for time_s, height in heard if time_s < 0.33]
    assert len(falling) > 4
    assert [height for _, height in falling] == pytest.approx(
        [0.6 - 9.81 / 2 * time_s**2 for time_s, _ in falling], abs=5e-3
    )
    assert heard[-1][1] == pytest.approx(0.025, abs=1e-3)


def test_two_runs_find_the_same_to_the_bit(tmp_path: Path) -> None:
    async def main() -> list[bytes]:
        heard: list[bytes] = []
        async with OpenCell(cell_with(tmp_path, height=0.3, detect="{noise_m: 0.001}"), seed=4) as cell:
            topic = cell.bus.topic("top/detections", Detections)
            topic.subscribe(lambda message: heard.append(msgspec.msgpack.encode(message)))
            await asyncio.sleep(1.5)
        return heard

    first = run_virtual(main())
    assert len(first) > 3
    assert run_virtual(main()) == first


def test_who_waits_when_the_cell_closes_or_the_camera_fails_is_notified(tmp_path: Path) -> None:
    async def main() -> tuple[str, str]:
        async with OpenCell(cell_with(tmp_path)) as cell:
            assert isinstance(cell.world, SimWorld)
            (cameras,) = (each for each in cell.world.devices() if isinstance(each, LockstepPerception))
            asked = asyncio.create_task(cell.bus.call(DetectObjects(), to="top"))
            await asyncio.sleep(0.0)
            cameras.fail("its lens is covered")
            with pytest.raises(SkillFailed) as failed:
                await asked
            again = await cell.bus.call(DetectObjects(), to="top")
            assert again.detections
            asked = asyncio.create_task(cell.bus.call(DetectObjects(), to="top"))
            await asyncio.sleep(0.0)
        with pytest.raises(SkillFailed) as closed:
            await asked
        return failed.value.message, closed.value.message

    failed, closed = run_virtual(main())
    assert failed == "nothing can be detected: its lens is covered"
    assert closed == "nothing can be detected: the cell is closed"


def test_a_cell_without_a_map_still_gives_images_and_has_no_occupancy(tmp_path: Path) -> None:
    async def main() -> tuple[list[str], set[str]]:
        images: list[DepthImage] = []
        async with OpenCell(cell_with(tmp_path)) as cell:
            cell.bus.topic("side/depth", DepthImage).subscribe(images.append)
            await asyncio.sleep(0.5)
            names = {entry.name for entry in cell.bus.listing()}
        return [image.camera for image in images], names

    images, names = run_virtual(main())
    assert len(images) == 2
    assert {"top/detections", "top/detect_objects", "top/detect_always", "top/detection_rate_hz"} <= names
    assert not {"cell/occupancy", "side/detections", "side/detect_objects"} & names


def test_with_a_map_detections_come_beside_it(tmp_path: Path) -> None:
    more = "occupancy: {center_m: [0.4, 0.0, 0.4], size_m: [0.8, 1.2, 0.8]}"

    async def main() -> tuple[Detections, int]:
        async with OpenCell(cell_with(tmp_path, more=more)) as cell:
            assert isinstance(cell.world, SimWorld)
            (cameras,) = (each for each in cell.world.devices() if isinstance(each, LockstepPerception))
            cameras.require()
            found = await cell.bus.call(DetectObjects(), to="top")
            await asyncio.sleep(0.5)
            assert cameras.latest is not None
            return found, cameras.latest.revision

    found, revision = run_virtual(main())
    assert len(found.detections) == 2
    assert revision >= 1


def test_labels_of_parts_that_are_not_there_are_refused_with_the_nearest_name(tmp_path: Path) -> None:
    async def main() -> None:
        async with OpenCell(cell_with(tmp_path, detect="{labels: {cub: front}}")):
            pass

    with pytest.raises(CellError, match=r"label for cub, which is not a part of the cell.*did you mean cube"):
        run_virtual(main())


def test_the_frame_world_cannot_stand_elsewhere(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match="choose another frame name"):
        cell_with(tmp_path, detect="{frame_at: {xyz: [1, 0, 0]}}")
