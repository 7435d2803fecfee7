"""`flexcell cell reach`: a table by height, and the points in files."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.engine.cli.command import flexcell

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: ur10, base: {xyz: [0, 0, 1.0]}}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a cell of one arm."""
    (tmp_path / "cell.yaml").write_text(CELL)
    return tmp_path


def test_the_layers_are_reported_and_the_points_written(folder: Path) -> None:
    options = ("--step", "0.5", "--direction", "down")
    said = flexcell("cell", "reach", "cell.yaml", "left", *options, "-o", "r.json", cwd=folder)
    assert said.code == 0, said.err
    level = json.loads((folder / "r.json").read_text())
    heights = {point["xyz"][2] for point in level["points"]}
    lines = said.out.splitlines()
    assert lines[0].split()[:4] == ["z", "in", "m", "points"]
    assert len(lines) == len(heights) + 4
    assert lines[-2].endswith("points 0.5 m apart, 1 directions")
    # The base is 1 m up, and the arm reaches about 1.3 m from there.
    assert min(heights) > -0.6
    assert "to go" in said.err


def test_a_cloud_has_as_many_points_as_it_says(folder: Path) -> None:
    said = flexcell("cell", "reach", "cell.yaml", "left", "--step", "0.5", "-o", "r.ply", cwd=folder)
    assert said.code == 0, said.err
    head, _, body = (folder / "r.ply").read_text().partition("end_header\n")
    count = next(int(line.split()[2]) for line in head.splitlines() if line.startswith("element vertex"))
    assert count == len(body.splitlines()) > 0
    assert all(len(line.split()) == 8 for line in body.splitlines())


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("cell.yaml", "lefd"), "the cell has no robot `lefd` (did you mean left?)"),
        (("cell.yaml", "left", "-o", "r.stl"), "r.stl has an unknown ending"),
    ],
)
def test_an_unknown_arm_or_ending_is_refused(folder: Path, arguments: tuple[str, ...], why: str) -> None:
    said = flexcell("cell", "reach", *arguments, cwd=folder)
    assert (said.code != 0, why in said.err) == (True, True), said.err
