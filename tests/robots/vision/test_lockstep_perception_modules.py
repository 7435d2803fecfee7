"""Cameras see a module that is plugged, know it, and stay healthy when it comes and goes."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import Cell, load_cell
from engine.messages.sensing import CameraStatus, OccupancyGrid
from engine.skills.modules import PlugModule, UnplugModule
from engine.skills.vision import DetectObjects
from robots.vision.voxel_box import occupied_centres
from tests.robots.vision.test_lockstep_perception_occupancy import cameras_of

CELL = """\
flexcell: 1
cell: watched
world: {kind: mujoco, step_s: 0.002}
robots:
  arm: {model: servo_arm, driver: sim, base: {xyz: [0, 0, 0]}}
fixtures:
  floor: {shape: box, size_m: [2.6, 2.6, 0.04], at: {xyz: [0.3, 0, -0.02]}}
unknown_bodies:
  forgotten: {shape: box, size_m: [0.1, 0.1, 0.1], at: {xyz: [0.6, -0.4, 0.05]}}
connectors:
  dock: {at: {xyz: [0.7, 0.5, 0]}}
modules:
  shelf: {module: shelf, connector: dock, plugged: PLUGGED}
cameras:
  top: {at: [0.9, 0.0, 1.8], look_at: [0.4, 0, 0.1], fov_rad: 1.2, noise_m: 0.001, detect: {labels: {shelf/cube: cube}}}
occupancy: {center_m: [0.4, 0.0, 0.4], size_m: [0.8, 1.2, 0.8]}
"""
SHELF = """\
flexcell: 1
module: shelf
fixtures:
  body: {shape: box, size_m: [1.0, 0.8, 0.3], at: {xyz: [0, 0, 0.15]}}
parts:
  cube: {shape: box, size_m: [0.08, 0.08, 0.08], mass_kg: 0.1, at: {xyz: [0, 0, 0.34]}}
"""


def shelf_cell(folder: Path, *, plugged: bool) -> Cell:
    """Return the cell of a shelf before a camera."""
    (folder / "shelf").mkdir()
    (folder / "shelf" / "module.yaml").write_text(SHELF, encoding="utf-8")
    (folder / "cell.yaml").write_text(CELL.replace("PLUGGED", "true" if plugged else "false"), encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def condition(cell: OpenCell) -> str:
    """Return the condition of the camera."""
    status = cell.bus.topic("top/status", CameraStatus).latest
    assert status is not None
    return status.condition


def unknown_near_the_dock(cell: OpenCell) -> int:
    """Return how many voxels above the dock the map has as occupied by what nobody knows; there are others."""
    grid: OccupancyGrid | None = cameras_of(cell).latest
    assert grid is not None
    centres = occupied_centres(grid)
    assert len(centres) > 10
    inside = (abs(centres[:, 0] - 0.7) < 0.6) & (abs(centres[:, 1] - 0.5) < 0.5)
    return int(inside.sum())


async def labels(cell: OpenCell) -> set[str]:
    """Return what the detector finds."""
    found = await cell.bus.call(DetectObjects(), to="top")
    return {each.label for each in found.detections}


@pytest.mark.parametrize("plugged", [True, False], ids=["plugged at the start", "plugged later"])
def test_a_shelf_is_no_unknown_object_and_no_fault_of_the_camera(tmp_path: Path, *, plugged: bool) -> None:
    """A camera expects to see its surfaces, and what is behind them once it has gone."""

    async def main() -> None:
        async with OpenCell(shelf_cell(tmp_path, plugged=plugged)) as cell:
            cameras_of(cell).require()
            is_there = plugged
            for _ in range(3):
                await asyncio.sleep(1.5)
                assert (condition(cell), unknown_near_the_dock(cell)) == ("healthy", 0)
                assert await labels(cell) == ({"cube"} if is_there else set())
                await cell.bus.call(UnplugModule() if is_there else PlugModule(), to="shelf")
                is_there = not is_there

    run_virtual(main())
