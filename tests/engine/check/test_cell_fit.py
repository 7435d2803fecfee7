"""Whether a behavior that is written for one cell can be executed in the connected one."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.check import cell_fit
from engine.document import load_behavior, load_cell
from tests.engine.check.checking import CATALOGUE, HEAD

MOVE = """\
cell: home.yaml
root:
  machine:
    initial: go
    states:
      go:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: home}}
        transitions: {reached: good, failed: bad}
"""
CELL = "flexcell: 1\ncell: NAME\nworld: {kind: mujoco}\nrobots: {ROBOTS}\n"


@pytest.mark.parametrize(
    ("robots", "reason"),
    [
        ("left: {model: panda}", ""),
        ("left: {model: panda, base: {xyz: [1, 0, 0]}}, right: {model: ur10}", ""),
        ("left: {model: ur10}", "the robot left is panda there and ur10 here"),
        ("left: {model: panda, gripper: {model: franka_hand}}", "panda there and panda with franka_hand here"),
        ("right: {model: panda}", "left"),
    ],
)
def test_another_cell_fits_if_it_has_the_same_robots(tmp_path: Path, robots: str, reason: str) -> None:
    for name, text in {"home": "left: {model: panda}", "other": robots}.items():
        content = CELL.replace("NAME", name).replace("ROBOTS", text)
        (tmp_path / f"{name}.yaml").write_text(content, encoding="utf-8")
    file = tmp_path / "move.yaml"
    file.write_text(HEAD + MOVE, encoding="utf-8")
    fit = cell_fit(load_behavior(file), CATALOGUE, load_cell(tmp_path / "other.yaml"))
    assert fit.cell == "home"
    assert fit.obstacle.startswith("it is written for the cell home, and other is connected: ") == bool(reason)
    assert reason in fit.obstacle


def test_its_own_cell_fits_and_so_does_a_behavior_of_any_cell(tmp_path: Path) -> None:
    (tmp_path / "home.yaml").write_text(CELL.replace("NAME", "home").replace("ROBOTS", ""), encoding="utf-8")
    file = tmp_path / "move.yaml"
    file.write_text(HEAD + MOVE, encoding="utf-8")
    cell = load_cell(tmp_path / "home.yaml")
    assert cell_fit(load_behavior(file), CATALOGUE, cell).obstacle == ""
    assert cell_fit(load_behavior(file), CATALOGUE, None).obstacle == ""
    file.write_text(HEAD + MOVE.replace("cell: home.yaml\n", ""), encoding="utf-8")
    assert cell_fit(load_behavior(file), CATALOGUE, cell).cell == ""
