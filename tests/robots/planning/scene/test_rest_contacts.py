"""What touches in a cell before anything has moved: arms, parts, and what modules bring."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import Cell, load_cell
from robots.planning.scene.rest_contacts import rest_contacts

CELLS = Path(__file__).resolve().parents[4] / "behaviors" / "cells"
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots: {left: {model: panda, gripper: {model: panda_hand}}}
connectors: {dock: {at: {xyz: [0, 1.0, 0]}}}
modules: {rack: {module: rack, connector: dock}}
fixtures:
  table: {shape: box, size_m: [0.5, 0.5, 0.1], at: {xyz: [0.8, 0, 0.05]}}
  leg: {shape: box, size_m: [0.1, 0.1, 0.1], at: {xyz: [0.8, 0, 0.05]}}
  tray: {shape: tray, size_m: [0.2, 0.2, 0.1], wall_m: 0.01, at: {xyz: [0.8, 0.9, 0]}}
parts:
  block: {shape: box, size_m: [0.05, 0.05, 0.05], mass_kg: 0.1, at: {xyz: [0.8, 0, 0.125]}}
  ball: {shape: sphere, size_m: [0.05], mass_kg: 0.1, at: {xyz: [0.8, 0.9, 0.04]}}
"""
MODULE = """\
flexcell: 1
module: rack
fixtures: {board: {shape: box, size_m: [0.4, 0.4, 0.02], at: {xyz: [0, 0, 0.5]}}}
"""


def cell_of(folder: Path, *, replacing: str = "", by: str = "") -> Cell:
    (folder / "rack").mkdir()
    (folder / "rack" / "module.yaml").write_text(MODULE)
    (folder / "cell.yaml").write_text(CELL.replace(replacing, by) if replacing else CELL)
    return load_cell(folder / "cell.yaml")


def test_parts_that_lie_on_a_table_or_in_a_tray_touch_nothing_that_matters(tmp_path: Path) -> None:
    """Neither do fixtures of one document that overlap, nor the arm and what it stands on."""
    assert rest_contacts(cell_of(tmp_path)) == ()


@pytest.mark.parametrize("name", sorted(file.name for file in CELLS.glob("*.yaml")))
def test_in_shipped_cells_nothing_touches(name: str) -> None:
    assert rest_contacts(load_cell(CELLS / name)) == ()


@pytest.mark.parametrize(
    ("replacing", "by", "pair", "distance_m"),
    [
        ("xyz: [0.8, 0, 0.125]", "xyz: [0.8, 0, 0.115]", {"table", "block"}, -0.01),
        ("xyz: [0.8, 0.9, 0.04]", "xyz: [0.875, 0.9, 0.04]", {"tray", "ball"}, -0.01),
        ("dock: {at: {xyz: [0, 1.0, 0]}}", "dock: {at: {xyz: [0.8, 0, -0.405]}}", {"table", "rack/board"}, -0.015),
    ],
)
def test_a_body_inside_of_another_is_reported_with_its_depth(
    tmp_path: Path, replacing: str, by: str, pair: set[str], distance_m: float
) -> None:
    found = {
        frozenset((each.first, each.second)): each.distance_m
        for each in rest_contacts(cell_of(tmp_path, replacing=replacing, by=by))
    }
    assert found[frozenset(pair)] == pytest.approx(distance_m, abs=1e-4)


def test_an_arm_that_is_nearer_than_the_margin_is_reported_with_its_link(tmp_path: Path) -> None:
    """The distance is that of the shapes, the margin of who asks."""
    cell = cell_of(tmp_path, replacing="at: {xyz: [0.8, 0, 0.05]}}\n  leg", by="at: {xyz: [0.5, 0, 0.5]}}\n  leg")
    touching = [each for each in rest_contacts(cell) if "table" in (each.first, each.second) and each.distance_m <= 0]
    assert any(each.first.startswith("left/") for each in touching)
    free = load_cell(tmp_path / "cell.yaml")
    near = rest_contacts(free, margin_m=1.0)
    assert len(near) > len(rest_contacts(free))
