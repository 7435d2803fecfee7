"""Parts and slots of modules: an arm takes a part from one module and puts it into a slot of another, in physics."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import load_cell
from tests.behaviors.application import Application, causes

MODULE = """\
flexcell: 1
module: bin
frames:
  slot_1: {parent: tray, at: {xyz: [-0.06, 0, 0.005]}}
  slot_2: {parent: tray, at: {xyz: [0.06, 0, 0.005]}}
fixtures:
  tray: {shape: tray, size_m: [0.3, 0.16, 0.03]}
parts:
  block: {shape: box, size_m: [0.06, 0.03, 0.04], mass_kg: 0.1, at: {frame: slot_1, xyz: [0, 0, 0.02]}}
"""
CELL = """\
flexcell: 1
cell: docked
world: {kind: mujoco}
robots: {arm: {model: panda, gripper: {model: panda_hand}}}
fixtures:
  table: {shape: box, size_m: [0.6, 1.2, 0.4], at: {xyz: [0.6, 0, 0.2]}}
connectors:
  dock_1: {parent: table, at: {xyz: [-0.1, 0.3, 0.2]}}
  dock_2: {parent: table, at: {xyz: [-0.1, -0.3, 0.2], rpy: [0, 0, 1.5707963]}}
modules:
  full: {module: bin, connector: dock_1}
  other: {module: bin, connector: dock_2}
"""
BEHAVIOR = """\
flexcell: 1
name: from_module_to_module
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: pick
    states:
      pick:
        state: manipulation.PickPart
        with: {robot: arm, part: full/block, grasp: {xyz: [0, 0, 0], xyzw: [1, 0, 0, 0], frame: part}, width_m: 0.03}
        transitions: {picked: place, missed: failed, unreachable: failed, blocked: failed, failed: failed}
      place:
        state: manipulation.PlacePart
        with:
          robot: arm
          part: full/block
          target: {xyz: [0, 0, 0.021], xyzw: [0, 0, 0, 1], frame: other/slot_2}
          target_of: part
          approach: [0, 0, 1]
        transitions: {placed: finished, missed: failed, unreachable: failed, blocked: failed, failed: failed}
"""


def test_a_part_is_taken_from_a_module_and_put_into_a_slot_of_another(tmp_path: Path) -> None:
    """The other one is docked turned by 90°, so that its second slot is before the table along y."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "module.yaml").write_text(MODULE, encoding="utf-8")
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    (tmp_path / "behavior.yaml").write_text(BEHAVIOR, encoding="utf-8")
    done = Application(behavior=str(tmp_path / "behavior.yaml"), cell=load_cell(tmp_path / "cell.yaml"))
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    assert done.last("full/block").xyz == pytest.approx((0.5, -0.24, 0.425), abs=0.004)
    assert done.last("other/block").xyz == pytest.approx((0.5, -0.36, 0.425), abs=0.002)
