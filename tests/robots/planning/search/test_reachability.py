"""Targets are checked with the fixtures that are there when the cell is opened, in all frames of the cell."""

from __future__ import annotations

from pathlib import Path

from engine.messages import Pose
from engine.skills.arm_target import ArmTarget
from robots.planning.search.reachability import ReachabilityChecker
from tests.robots.module_cell import CELL, MODULE, module_cell

DOWN = (1.0, 0.0, 0.0, 0.0)
TALL = MODULE.replace("fixtures:", "fixtures:\n  mast: {shape: box, size_m: [0.3, 0.3, 2], at: {xyz: [0, 0, 1]}}")
AT_BASE = CELL.replace("base: {xyz: [0, 0.4, 0]}", "base: {xyz: [0, 0, 0]}")


def test_a_module_that_is_not_plugged_is_in_no_ones_way_and_its_slots_are_known(tmp_path: Path) -> None:
    """The one without a connector has no place yet: not at the origin of the world either, where an arm stands."""
    checker = ReachabilityChecker(module_cell(tmp_path, cell=AT_BASE, module=TALL))
    pose = Pose(xyz=(0.0, 0.0, 0.1), xyzw=DOWN, frame="full/slot_1")
    assert checker.fault(ArmTarget(robot="left", parameter="target", pose=pose)) is None
