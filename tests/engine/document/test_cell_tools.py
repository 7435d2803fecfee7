"""Tools of tool changers as data: what does not fit is refused at its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document import Placement, ToolShape, ToolSpec, centre_of_mass
from engine.document.cell import load_cell
from engine.errors import DocumentError

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  arm: {model: panda, tool_changer: {force_n: 300}}
parts:
  probe:
    shape: cylinder
    size_m: [0.06, 0.02]
    mass_kg: 0.3
    tool:
      tcps: {tip: {xyz: [0, 0, 0.09]}}
      shapes:
        - {shape: box, size_m: [0.02, 0.02, 0.08], mass_kg: 0.1, at: {xyz: [0, 0, 0.05]}}
"""


def load(folder: Path, old: str = "", new: str = "") -> None:
    """Read the cell with a text replaced."""
    assert old in CELL
    (folder / "cell.yaml").write_text(CELL.replace(old, new) if old else CELL, encoding="utf-8")
    load_cell(folder / "cell.yaml")


@pytest.mark.parametrize(
    ("old", "new", "message", "line"),
    [
        ("tool_changer:", "gripper: {model: panda_hand}, tool_changer:", "has both a gripper and a tool changer", 5),
        ("tool_changer:", "driver: {kind: franka}, tool_changer:", "tool changers are only simulated", 5),
        ("shape: cylinder\n    size_m: [0.06, 0.02]", "shape: sphere\n    size_m: [0.06]", "which has no face", 8),
        ("[0.02, 0.02, 0.08]", "[0.02, 0.08]", "the size of a box has 3 lengths, not 2", 14),
        ("tip: {xyz: [0, 0, 0.09]}", "", "tcps", 12),
        ("force_n: 300", "force_n: 0", "force_n", 5),
    ],
)
def test_what_does_not_fit_is_refused_at_its_place(tmp_path: Path, old: str, new: str, message: str, line: int) -> None:
    load(tmp_path)
    with pytest.raises(DocumentError) as refused:
        load(tmp_path, old, new)
    assert message in str(refused.value)
    assert f"cell.yaml:{line}:" in str(refused.value)


def test_the_centre_of_mass_is_that_of_all_bodies() -> None:
    shape = ToolShape(shape="sphere", size_m=(0.02,), mass_kg=0.1, at=Placement(xyz=(0.04, 0.0, 0.08)))
    mass_kg, com_m = centre_of_mass(0.3, ToolSpec(tcps={"tip": Placement()}, shapes=(shape,)))
    assert mass_kg == pytest.approx(0.4)
    assert com_m == pytest.approx((0.01, 0.0, 0.02))
