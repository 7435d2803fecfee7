"""The files that a cell names: what they contain decides its runs as much as the document does."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from engine.document.cell import Cell


def written_paths(cell: Cell) -> Iterator[str]:
    """Yield the paths of all files as a cell writes them: built-in models have none."""
    store = cell.document.store
    if store is not None and store.seed is not None:
        yield store.seed
    yield from (each.pins for each in cell.document.equipment.values() if each.pins is not None)
    yield from cell.meshes
    yield from _models(cell)


def model_paths(cell: Cell) -> list[Path]:
    """Return the model folders and calibrations of a cell."""
    return [cell.resolve(path) for path in _models(cell)]


def model_files(cell: Cell) -> Iterator[Path]:
    """Yield the calibrations, equipment documents and meshes of a cell, and the files in its model folders."""
    yield from (equipment.file for equipment in cell.pins.values())
    yield from (cell.resolve(mesh) for mesh in cell.meshes)
    for path in model_paths(cell):
        yield from (file for file in sorted(path.rglob("*")) if file.is_file()) if path.is_dir() else (path,)


def _models(cell: Cell) -> Iterator[str]:
    for robot in cell.document.robots.values():
        models = [robot.model] if robot.gripper is None else [robot.model, robot.gripper.model]
        yield from (model for model in models if model.startswith(".") or "/" in model)
        if robot.calibration is not None:
            yield robot.calibration
