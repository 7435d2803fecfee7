"""Bodies that touch at rest are warned of where they stand, at one of them or at both."""

from __future__ import annotations

from pathlib import Path

from engine.check import check_rest, check_rest_of_items
from engine.document.cell import load_cell

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: panda}
fixtures:
  post: {shape: box, size_m: [0.1, 0.1, 1.0], at: {xyz: [0.4, 0, 0.5]}}
"""


def test_a_pair_is_found_once_or_at_both_of_its_items(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(CELL)
    cell = load_cell(file)
    found = check_rest_of_items(cell)
    assert {(each.code, each.severity, each.path, each.position.line) for each in found} == {
        ("collision-at-rest", "warning", "robots/left", 5),
        ("collision-at-rest", "warning", "fixtures/post", 7),
    }
    assert "`post` overlap by" in found[0].message
    assert len(check_rest(cell)) * 2 == len(found)


def test_a_cell_whose_arm_has_no_model_has_no_such_finding(tmp_path: Path) -> None:
    """Another check says what is wrong with it."""
    file = tmp_path / "cell.yaml"
    file.write_text(CELL.replace("model: panda", "model: ponda"))
    assert check_rest(load_cell(file)) == ()
