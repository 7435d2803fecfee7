"""The digital outputs of a controller are known of its driver, and are the same while the arm is simulated."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.check import check_cell
from engine.document import Cell, load_cell
from engine.document.simulated_devices import with_simulated_devices
from engine.registry import load_states
from engine.testing import run_behavior

SERVO_ARM = "{model: servo_arm, driver: {kind: servo_arm, device: /dev/ttyACM7}, outputs: {gripper: 0}}"
SWITCHED = "{model: irb4600, driver: {kind: abb_irc5, host: 127.0.0.1, gripper: {}}, outputs: {gripper: 0}}"
BARE = "{model: irb4600, driver: {kind: abb_irc5, host: 127.0.0.1}, outputs: {gripper: 0}}"
SECOND = "{model: servo_arm, driver: {kind: servo_arm, device: /dev/ttyACM7}, outputs: {gripper: 1}}"
BEHAVIOR = """\
flexcell: 1
name: switch
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: "on"
    states:
      "on":
        state: io.SetOutput
        with: {robot: arm, device: gripper, value: true}
        transitions: {set: finished, failed: failed}
"""


def cell_with(folder: Path, arm: str) -> Cell:
    text = f"flexcell: 1\ncell: bench\nworld: {{kind: mujoco}}\nrobots:\n  arm: {arm}\n"
    (folder / "cell.yaml").write_text(text, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def findings(cell: Cell) -> list[str]:
    return [found.message for found in check_cell(cell)]


@pytest.mark.parametrize("arm", [SERVO_ARM, SWITCHED])
def test_an_output_that_only_the_controller_has_is_none_that_is_missing(tmp_path: Path, arm: str) -> None:
    cell = cell_with(tmp_path, arm)
    assert findings(cell) == findings(with_simulated_devices(cell, ["all"])) == []


@pytest.mark.parametrize(("arm", "number"), [(BARE, 0), (SECOND, 1)])
def test_an_output_that_the_controller_lacks_is_found_real_or_simulated(tmp_path: Path, arm: str, number: int) -> None:
    cell = cell_with(tmp_path, arm)
    assert findings(cell) == findings(with_simulated_devices(cell, ["all"])) == [f"`arm` has no output {number}"]


def test_a_behavior_switches_it_in_the_simulation(tmp_path: Path) -> None:
    cell_with(tmp_path, SERVO_ARM)
    (tmp_path / "switch.yaml").write_text(BEHAVIOR, encoding="utf-8")
    run = run_behavior(
        tmp_path / "switch.yaml", catalogue=load_states(tmp_path), store=tmp_path / "store.db", simulate=["all"]
    )
    assert run.outcome == "finished"
