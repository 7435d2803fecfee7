"""Belts in physics: what lies on them is carried by friction, as fast as that accelerates it, and stops with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from robots.sim.commands.world_commands import DriveAxis, RestoreWorld
from tests.robots.sim.bond_rig import BondRig

BELT = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
fixtures:
  belt: {shape: box, size_m: [0.2, 3, 0.04], at: {xyz: [0, 0, 0.1], rpy: [0, 0, 0]}}
  gate: {shape: box, size_m: [0.2, 0.02, 0.05], at: {xyz: [0, 0.6, 0.15]}}
parts:
  box: {shape: box, size_m: [0.06, 0.06, 0.04], mass_kg: 0.2, at: {xyz: [0, -0.5, 0.1401]}}
devices:
  conveyor:
    belts:
      main: {body: belt, along: [0, 1, 0], speed_m_s: 0.3, acceleration_m_s2: 20, friction: 0.5, output: run}
    positions:
      running: {steps: [{set: {run: true}}], time: 0}
"""
START_M = -0.5


@pytest.fixture(name="rig")
def _rig(tmp_path: Path) -> BondRig:
    rig = BondRig(tmp_path, BELT)
    rig.pass_time(0.2)
    return rig


def drive(rig: BondRig, direction: float, *, locked: bool = False) -> None:
    """Run the belt from the next step on."""
    rig.apply(DriveAxis(fixture="belt", direction=direction, locked=locked))


def test_a_part_is_brought_at_the_speed_of_the_belt_and_stops_with_it(rig: BondRig) -> None:
    """Friction accelerates it to 0.3 m/s in 61 ms, in which it stays 9 mm behind."""
    drive(rig, 1.0)
    rig.pass_time(2.0)
    assert rig.place("box")[1] - START_M == pytest.approx(0.6 - 0.009 - 0.002, abs=0.004)
    before = rig.place("box")
    rig.pass_time(0.5)
    assert rig.place("box")[1] - before[1] == pytest.approx(0.15, abs=0.002)
    drive(rig, 0.0)
    rig.pass_time(0.3)
    resting = rig.place("box")
    rig.pass_time(1.0)
    assert np.linalg.norm(rig.place("box") - resting) < 5e-4
    drive(rig, -1.0)
    rig.pass_time(1.0)
    assert rig.place("box")[1] < resting[1] - 0.25


def test_a_light_push_does_not_move_it_on_a_belt_that_stands_and_a_strong_one_does(rig: BondRig) -> None:
    """Friction holds 0.98 N."""
    before = rig.place("box")
    rig.push("box", 0.0, 0.7, 0.0)
    rig.pass_time(1.0)
    assert np.linalg.norm(rig.place("box") - before) < 1e-3
    rig.push("box", 0.0, 1.3, 0.0)
    rig.pass_time(1.0)
    assert rig.place("box")[1] - before[1] > 0.1


def test_a_part_at_a_gate_stays_there_while_the_belt_slides_below(rig: BondRig) -> None:
    drive(rig, 1.0)
    rig.pass_time(5.0)
    assert rig.place("box")[1] == pytest.approx(0.56, abs=0.003)


def test_a_stuck_belt_stands_at_once(rig: BondRig) -> None:
    drive(rig, 1.0)
    rig.pass_time(1.0)
    drive(rig, 1.0, locked=True)
    rig.pass_time(0.3)
    before = rig.place("box")
    rig.pass_time(1.0)
    assert np.linalg.norm(rig.place("box") - before) < 5e-4


def test_a_belt_stands_in_a_restored_world_until_it_is_driven_anew(rig: BondRig) -> None:
    drive(rig, 1.0)
    rig.pass_time(0.5)
    image = rig.image()
    rig.pass_time(0.5)
    rig.apply(RestoreWorld(image=image))
    rig.pass_time(0.2)
    before = rig.place("box")
    rig.pass_time(0.5)
    assert np.linalg.norm(rig.place("box") - before) < 1e-3
    drive(rig, 1.0)
    rig.pass_time(0.5)
    assert rig.place("box")[1] - before[1] > 0.1
