"""The names of a cell: which there are of each kind, and what is said of one that is not there."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cell import cell_names as module
from engine.cell.cell_names import CellNameKind, CellNames, cell_names
from engine.document.cell import load_cell

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: panda, gripper: {model: panda_hand}}
  right: {model: ur10, outputs: {gripper: 2}, tool_changer: {}}
parts:
  plate: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1}
  probe: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1, tool: {tcps: {tip: {}}}}
frames: {slot: {at: {xyz: [0.3, 0, 0]}}}
"""


@pytest.fixture
def names(tmp_path: Path) -> CellNames:
    """Those of a cell with two robots and a part."""
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    return cell_names(load_cell(tmp_path / "cell.yaml"))


@pytest.mark.parametrize(
    ("kind", "name", "message", "advice"),
    [
        ("robot", "lft", "the cell bench has no robot `lft`", "did you mean left?"),
        ("gripper", "right", "the cell bench has no robot with a gripper `right`", "`right` is a robot"),
        ("arm_frame", "plate", "the cell bench has no frame for the poses of an arm `plate`", "`plate` is a part"),
        ("output", "right/linear_axis", "`right` of the cell bench has no output `linear_axis`", "known: 0, 1, 2, 3"),
        ("tool_changer", "left", "the cell bench has no robot with a tool changer `left`", "`left` is a robot"),
        ("changeable_tool", "plate", "the cell bench has no part that is a tool `plate`", "`plate` is a part"),
        ("tool_point", "probe/tp", "`probe` of the cell bench has no tool centre point `tp`", "did you mean tip?"),
        ("tool", "right/gripper", "`right` of the cell bench has no tool `gripper`", "there are none"),
    ],
)
def test_what_is_said_of_a_name(names: CellNames, kind: CellNameKind, name: str, message: str, advice: str) -> None:
    """What it is, where it is missing, and what it may have meant."""
    assert not names.has(kind, name)
    assert names.missing(kind, name) == message
    assert names.advice(kind, name).startswith(advice)


def test_a_named_frame_is_one_for_the_poses_of_arms_and_one_of_the_view(names: CellNames) -> None:
    """And what is like it is told."""
    assert names.has("arm_frame", "slot")
    assert names.has("frame", "slot")
    assert names.advice("arm_frame", "slto") == "did you mean slot?"


def test_without_models_tools_and_links_may_be_any(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An engine that is installed alone still knows robots, parts and cameras."""
    monkeypatch.setattr(module, "robot_models", lambda: None)
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    names = cell_names(load_cell(tmp_path / "cell.yaml"))
    assert names.has("planner", "whatever")
    assert names.has("link", "left/whatever")
    assert (names.has("magnet", "left"), names.has("magnet", "right")) == (True, False)
    assert (names.has("robot", "left"), names.has("robot", "lft"), names.has("part", "plate")) == (True, False, True)


def test_the_lists_are_sorted(names: CellNames) -> None:
    """As the editor offers them."""
    listed = names.listed()
    assert listed["robot"] == ("left", "right")
    assert listed["frame"] == tuple(sorted(listed["frame"]))
