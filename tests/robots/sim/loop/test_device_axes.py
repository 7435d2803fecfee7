"""Axes of devices in the physics: jaws press with their force and hold by friction, and let go without air."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.document.cell import load_cell
from engine.skills.simulated_world import PushBody
from robots.port import Array
from robots.scene.scene_builder import build_scene
from robots.sim.commands.world_commands import DriveAxis, PushSimBody
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell

# Two faces with 60 N and a coefficient of 0.4 hold 48 N.
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
fixtures:
  fixed: {shape: box, size_m: [0.02, 0.08, 0.04], at: {xyz: [0.03, 0, 0.3]}}
  jaw: {shape: box, size_m: [0.02, 0.08, 0.04], at: {xyz: [-0.06, 0, 0.3]}}
  bed: {shape: box, size_m: [0.04, 0.08, 0.02], at: {xyz: [-0.015, 0, 0.26]}}
  turntable: {shape: box, size_m: [0.2, 0.2, 0.02], at: {xyz: [0.5, 0, 0.3]}}
parts:
  block: {shape: box, size_m: [0.03, 0.04, 0.04], mass_kg: 0.1, at: {xyz: [-0.01, 0, 0.29]}}
devices:
  vice:
    axes:
      main:
        {body: jaw, joint: slide, along: [1, 0, 0], stroke_m: 0.06, force_n: 60, speed_m_s: 0.05, friction: 0.4,
         against: [fixed], output: on}
      table:
        {body: turntable, joint: hinge, along: [0, 0, 1], stroke_rad: 1.5708, torque_nm: 2, speed_rad_s: 1, output: on}
    positions:
      closed: {steps: [{set: {on: true}}], time: 2}
"""


@pytest.fixture(name="vice")
def _vice(tmp_path: Path) -> Vice:
    file = tmp_path / "cell.yaml"
    file.write_text(CELL, encoding="utf-8")
    return Vice(Simulation(build_cell(build_scene(load_cell(file).document))))


class Vice:
    """A simulation with names for what is looked at."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation

    def press(self, fixture: str, direction: float, *, locked: bool = False) -> None:
        """Press an axis from the next step on."""
        self.simulation.apply(DriveAxis(fixture=fixture, direction=direction, locked=locked))

    def pull(self, *force_n: float) -> None:
        """Pull at the block for a second."""
        x, y, z = force_n
        self.simulation.apply(PushSimBody(push=PushBody(body="block", force_n=(x, y, z), duration_s=1.0)))
        self.pass_time(1.0)

    def pass_time(self, time_s: float) -> None:
        """Simulate."""
        for _ in range(round(time_s / self.simulation.step_s)):
            self.simulation.step()

    def place(self, body: str) -> Array:
        """Return the position of a body, (3,), and its turn about z."""
        values = self.simulation.layout.new_array()
        self.simulation.write_snapshot(values)
        layout = self.simulation.layout
        row = self.simulation.summary.frames.index(body)
        w, _, _, z = values[layout.quaternions].reshape(-1, 4)[row]
        return np.array([*values[layout.positions].reshape(-1, 3)[row], 2.0 * np.arctan2(z, w)])


def test_a_free_axis_has_its_speed_and_ends_at_its_stroke(vice: Vice) -> None:
    vice.press("turntable", 1.0)
    vice.pass_time(0.5)
    assert vice.place("turntable")[3] == pytest.approx(0.5, abs=0.02)
    vice.pass_time(1.5)
    assert vice.place("turntable")[3] == pytest.approx(1.5708, abs=0.01)
    vice.press("turntable", -1.0)
    vice.pass_time(2.0)
    assert vice.place("turntable")[3] == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("pull", [(0.0, 40.0, 0.0), (0.0, 0.0, 40.0)], ids=["along", "up"])
def test_jaws_hold_a_part_against_a_force_below_the_limit_of_friction(vice: Vice, pull: tuple[float, ...]) -> None:
    """It creeps by less than a millimetre in a second."""
    vice.press("jaw", 1.0)
    vice.pass_time(1.2)
    before = vice.place("block")
    vice.pull(*pull)
    assert np.linalg.norm((vice.place("block") - before)[:3]) < 1e-3


@pytest.mark.parametrize("pull", [(0.0, 56.0, 0.0), (0.0, 0.0, 56.0)], ids=["along", "up"])
def test_a_force_above_the_limit_of_friction_pulls_it_out(vice: Vice, pull: tuple[float, ...]) -> None:
    vice.press("jaw", 1.0)
    vice.pass_time(1.2)
    before = vice.place("block")
    vice.pull(*pull)
    assert np.linalg.norm((vice.place("block") - before)[:3]) > 0.05


def test_without_pressure_the_part_comes_out_with_a_small_force(vice: Vice) -> None:
    vice.press("jaw", 1.0)
    vice.pass_time(1.2)
    vice.press("jaw", 0.0)
    vice.pass_time(0.3)
    before = vice.place("block")
    vice.pull(0.0, 0.0, 3.0)
    assert (vice.place("block") - before)[2] > 0.05


def test_a_stuck_axis_stays_where_it_is(vice: Vice) -> None:
    vice.press("jaw", 1.0)
    vice.pass_time(0.3)
    before = vice.place("jaw")
    vice.press("jaw", 0.0, locked=True)
    vice.pass_time(1.0)
    assert np.linalg.norm((vice.place("jaw") - before)[:3]) < 1e-3
    vice.press("jaw", -1.0)
    vice.pass_time(1.0)
    assert vice.place("jaw")[0] == pytest.approx(-0.06, abs=1e-3)
