"""Separation monitoring needs something that measures, and a map that contains who is to be measured."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.check import check_cell
from engine.document.cell import load_cell
from engine.errors import DocumentError

_CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: panda}
cameras:
  top: {at: [0.4, 0, 2.5], look_at: [0.4, 0, 0]}
occupancy: {center_m: [0.4, 0, 0.5], size_m: [1.6, 1.6, 0.9], unknown_space: accept}
speed_and_separation_monitoring: {}
people:
  anna: {shoulder: [1.4, 0, 0.8], hand_rests: [1.1, 0, 0.6]}
"""


def _written(folder: Path, text: str) -> Path:
    file = folder / "bench.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_person_beyond_the_map_is_a_finding(tmp_path: Path) -> None:
    (finding,) = check_cell(load_cell(_written(tmp_path, _CELL)))
    assert finding.code == "person-beyond-map"
    assert "the shoulder of person `anna` is 0.20 m beyond the map" in finding.message
    assert finding.position is not None
    assert finding.position.line == 11


def test_a_map_that_contains_all_is_no_finding(tmp_path: Path) -> None:
    assert check_cell(load_cell(_written(tmp_path, _CELL.replace("size_m: [1.6", "size_m: [2.4")))) == ()


def test_without_a_map_nothing_measures(tmp_path: Path) -> None:
    text = "\n".join(line for line in _CELL.splitlines() if not line.startswith("occupancy"))
    with pytest.raises(DocumentError, match="nothing measures the distance of people"):
        load_cell(_written(tmp_path, text))
