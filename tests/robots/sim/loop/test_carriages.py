"""Carriages in physics: braked they hold up to their force, released they give way, and the arm on them knows it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.document.cell import load_cell
from engine.skills.simulated_world import PushBody
from robots.scene.scene_builder import build_scene
from robots.sim.commands.world_commands import BrakeCarriage, PushSimBody, RestoreWorld
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell

CELL = Path(__file__).parents[4] / "behaviors" / "cells" / "linear_unit.yaml"
FRICTION_N, HOLDING_N = 25.0, 1500.0


class Unit:
    """A simulation of an arm on a carriage with names for what is looked at."""

    def __init__(self) -> None:
        self.built = build_cell(build_scene(load_cell(CELL).document, seed=1))
        self.simulation = Simulation(self.built)

    def release(self) -> None:
        """Release the brakes."""
        self.simulation.apply(BrakeCarriage(carriage="carriage", force_n=FRICTION_N, released=True))

    def lock(self) -> None:
        """Lock the brakes."""
        self.simulation.apply(BrakeCarriage(carriage="carriage", force_n=HOLDING_N, released=False))

    def push(self, force_n: float, *, duration_s: float = 0.5) -> None:
        """Push the carriage along the rail, and see what it does then."""
        push = PushBody(body="carriage", force_n=(0.0, force_n, 0.0), duration_s=duration_s)
        self.simulation.apply(PushSimBody(push=push))
        self.pass_time(duration_s + 0.5)

    def pass_time(self, time_s: float) -> None:
        """Simulate."""
        for _ in range(round(time_s / self.simulation.step_s)):
            self.simulation.step()

    def at(self, body: str) -> list[float]:
        """Return where a body is in the world."""
        values = self.simulation.layout.new_array()
        self.simulation.write_snapshot(values)
        return values[self.simulation.layout.positions].reshape(-1, 3)[self.built.frames.index(body)].tolist()

    @property
    def place_mm(self) -> float:
        """Where the carriage is on its rail."""
        return 1e3 * (self.at("carriage")[1] + 0.4)


@pytest.fixture(name="unit")
def _unit() -> Unit:
    return Unit()


def test_a_braked_carriage_holds_less_than_its_force_and_slips_beyond_it(unit: Unit) -> None:
    unit.pass_time(1.0)
    assert abs(unit.place_mm) < 0.01
    unit.push(800.0)
    assert abs(unit.place_mm) < 0.01
    unit.push(2500.0, duration_s=0.1)
    assert unit.place_mm > 1.0


def test_a_released_carriage_stays_by_friction_and_gives_way_to_a_push(unit: Unit) -> None:
    unit.release()
    unit.pass_time(2.0)
    assert abs(unit.place_mm) < 0.02
    unit.push(20.0)
    assert abs(unit.place_mm) < 0.02
    unit.push(80.0)
    assert unit.place_mm > 20.0
    stands = unit.place_mm
    unit.lock()
    unit.push(80.0)
    assert unit.place_mm == pytest.approx(stands, abs=0.02)


def test_a_carriage_ends_at_the_end_of_its_rail(unit: Unit) -> None:
    unit.release()
    unit.push(-400.0, duration_s=1.0)
    assert unit.place_mm == pytest.approx(-50.0, abs=1.0)


def test_the_arm_on_it_moves_with_it_and_its_control_knows_where_it_stands(unit: Unit) -> None:
    before, stand = unit.at("arm/base_link"), unit.simulation.control("arm").stand
    known = stand.pose.xyz.copy()
    unit.release()
    unit.push(80.0)
    moved_m = unit.place_mm / 1e3
    assert np.subtract(unit.at("arm/base_link"), before) == pytest.approx((0.0, moved_m, 0.0), abs=1e-9)
    assert stand.pose.xyz - known == pytest.approx((0.0, moved_m, 0.0), abs=2e-6)


def test_a_restored_world_has_the_carriage_where_it_was(unit: Unit) -> None:
    unit.release()
    unit.push(80.0)
    unit.lock()
    unit.pass_time(0.3)
    before = unit.place_mm
    image = np.zeros(unit.simulation.image_layout.size)
    unit.simulation.write_image(image)
    unit.simulation = Simulation(unit.built)
    unit.simulation.apply(RestoreWorld(image=image))
    unit.pass_time(1.0)
    assert unit.place_mm == pytest.approx(before, abs=0.02)
    assert unit.simulation.control("arm").stand.pose.xyz[1] == pytest.approx(before / 1e3 - 0.4, abs=2e-5)
