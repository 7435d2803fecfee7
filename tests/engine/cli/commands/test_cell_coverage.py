"""`flexcell cell coverage`: the share of each region that the cameras see, and exit codes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.engine.cli.command import flexcell

CELL = """\
flexcell: 1
cell: shelf
world: {kind: mujoco}
fixtures:
  floor: {shape: box, size_m: [2, 2, 0.04], at: {xyz: [0, 0, -0.02]}}
  wall: {shape: box, size_m: [1.0, 0.04, 0.6], at: {xyz: [0, 0.2, 0.3]}}
cameras:
  front: {at: [0, -2, 1.0], look_at: [0, 0, 0.3], size_px: [160, 120]}
occupancy:
  center_m: [0, 0, 0.3]
  size_m: [0.8, 0.8, 0.6]
  must_cover:
    before: {center_m: [0, -0.1, 0.3], size_m: [0.6, 0.3, 0.4]}
    behind: {center_m: [0, 0.33, 0.12], size_m: [0.6, 0.1, 0.1]}
unknown_bodies:
  crate: {shape: box, size_m: [0.6, 0.1, 0.6], at: {xyz: [0, -0.6, 0.3]}}
"""


@pytest.fixture(name="cell")
def _cell(tmp_path: Path) -> Path:
    file = tmp_path / "shelf.yaml"
    file.write_text(CELL, encoding="utf-8")
    return file


def test_each_region_has_its_line_and_what_is_behind_a_wall_is_unseen(cell: Path) -> None:
    said = flexcell("cell", "coverage", cell, cwd=cell.parent)
    before, behind, whole = said.out.splitlines()
    assert said.code == 0, said.err
    assert before == "before: 100.0 % seen (front 100.0 %)"
    assert behind.startswith("behind: 0.0 % seen (front 0.0 %), unseen within (-0.3")
    assert whole.startswith("whole map: ")


def test_a_second_camera_on_the_other_side_sees_the_rest(cell: Path) -> None:
    back = "  back: {at: [0, 2, 1.0], look_at: [0, 0.2, 0.1], size_px: [160, 120]}\noccupancy:"
    cell.write_text(CELL.replace("occupancy:", back, 1), encoding="utf-8")
    said = flexcell("cell", "coverage", cell, "--fail-under", "99", cwd=cell.parent)
    assert said.code == 0, said.out
    assert said.out.splitlines()[1] == "behind: 100.0 % seen (front 0.0 %, back 100.0 %)"


def test_too_little_coverage_is_an_exit_code(cell: Path) -> None:
    assert flexcell("cell", "coverage", cell, "--fail-under", "50", cwd=cell.parent).code == 1


def test_a_cell_without_a_map_is_refused(cell: Path) -> None:
    text = CELL[: CELL.index("occupancy:")]
    cell.write_text(text, encoding="utf-8")
    said = flexcell("cell", "coverage", cell, cwd=cell.parent)
    assert said.code == 2, said
    assert "the cell has no cameras with an occupancy map" in said.err
