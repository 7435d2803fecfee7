"""Blades in physics: they part what they may cut, at its place, with enough force, and nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from robots.sim.commands.world_commands import DriveAxis
from tests.robots.sim.bond_rig import BondRig

# Two blades press with 120 N on the two sides of the seam between a board and its battery.
NIPPER = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
fixtures:
  bed: {shape: box, size_m: [0.3, 0.3, 0.02], at: {xyz: [0, 0, -0.01]}}
  left: {shape: box, size_m: [0.004, 0.04, 0.016], at: {xyz: [0, 0.085, 0.01]}}
  right: {shape: box, size_m: [0.004, 0.04, 0.016], at: {xyz: [0, -0.085, 0.01]}}
parts:
  board: {shape: box, size_m: [0.05, 0.04, 0.02], mass_kg: 0.06, at: {xyz: [-0.0255, 0, 0.0101]}}
  battery: {shape: box, size_m: [0.034, 0.04, 0.02], mass_kg: 0.05, at: {xyz: [0.0175, 0, 0.0101]}}
bonds:
  plus: {kind: solder, part: battery, to: board, at_m: [-0.0175, 0.02, 0], force_n: 100, torque_nm: 4, cut_n: 60}
  minus: {kind: solder, part: battery, to: board, at_m: [-0.0175, -0.02, 0], force_n: 100, torque_nm: 4, cut_n: 60}
devices:
  nipper:
    axes:
      left:
        {body: left, joint: slide, along: [0, -1, 0], stroke_m: 0.05, force_n: 120, speed_m_s: 0.1, cuts: [solder],
         output: close}
      right:
        {body: right, joint: slide, along: [0, 1, 0], stroke_m: 0.05, force_n: 120, speed_m_s: 0.1, cuts: [solder],
         output: close}
    positions:
      closed: {steps: [{set: {close: true}}], time: 1}
"""


def pressed(rig: BondRig, *, left: float = 1.0, locked: bool = False) -> dict[str, str]:
    """Press both blades, unless the left one is told otherwise, and return what has parted each bond."""
    rig.pass_time(0.1)
    rig.apply(DriveAxis(fixture="left", direction=0.0 if locked else left, locked=locked))
    rig.apply(DriveAxis(fixture="right", direction=1.0))
    rig.pass_time(1.2)
    return {name: bond.broken_by for name, bond in rig.bonds().items()}


WHOLE = {"plus": "", "minus": ""}


def test_two_blades_cut_a_battery_off_its_board_and_it_is_lifted_alone(tmp_path: Path) -> None:
    rig = BondRig(tmp_path, NIPPER)
    assert pressed(rig) == {"plus": "cut", "minus": "cut"}
    for name in ("left", "right"):
        rig.apply(DriveAxis(fixture=name, direction=-1.0))
    rig.pass_time(1.0)
    rig.push("battery", 0.0, 0.0, 1.0, duration_s=0.3)
    rig.pass_time(0.3)
    assert (rig.place("battery")[2] > 0.1, rig.place("board")[2] < 0.02) == (True, True)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("force_n: 120", "force_n: 50"),
        ("kind: solder", "kind: glue"),
        ("cuts: [solder]", "cuts: [clip]"),
        (", cut_n: 60", ""),
        ("-0.0175", "0"),
    ],
    ids=["too weak", "another kind", "a blade for another kind", "no blade parts it", "its place is elsewhere"],
)
def test_what_a_blade_may_not_or_cannot_cut_stays_whole(tmp_path: Path, old: str, new: str) -> None:
    assert old in NIPPER
    rig = BondRig(tmp_path, NIPPER.replace(old, new))
    assert pressed(rig) == WHOLE


@pytest.mark.parametrize("locked", [False, True], ids=["without air", "stuck"])
def test_one_blade_alone_pushes_the_board_away_and_cuts_nothing(tmp_path: Path, locked: bool) -> None:
    rig = BondRig(tmp_path, NIPPER)
    assert pressed(rig, left=0.0, locked=locked) == WHOLE
    assert rig.place("board")[1] > 0.003
