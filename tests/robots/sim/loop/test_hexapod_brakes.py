"""Hexapods in physics: braked legs hold up to their force without creeping, released ones carry the platform only."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.document.cell import load_cell
from engine.document.docking import cell_as_docked
from engine.skills.simulated_world import PushBody
from robots.model.transform import RigidTransform
from robots.scene.docked_scene import with_modules
from robots.scene.scene_builder import build_scene
from robots.sim.commands.world_commands import BrakeLegs, DriveAxis, PlaceModule, PushSimBody, RestoreWorld
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
connectors: {north: {at: {xyz: [0.5, 0.5, 0]}}, south: {at: {xyz: [0.5, -0.5, 0]}}}
modules: {jig: {module: HEXAPOD, connector: north}}
"""
HEXAPOD = Path(__file__).parents[4] / "behaviors" / "modules" / "hexapod"
FRICTION_N, HOLDING_N = 2.5, 400.0


class Jig:
    """A simulation of one hexapod with names for what is looked at."""

    def __init__(self, folder: Path) -> None:
        file = folder / "cell.yaml"
        file.write_text(CELL.replace("HEXAPOD", str(HEXAPOD)), encoding="utf-8")
        self.cell = load_cell(file)
        self.built = build_cell(with_modules(build_scene(self.cell.document), self.cell))
        self.simulation = Simulation(self.built)
        self.home = self.pose("jig/platform")

    def brake(self, force_n: float) -> None:
        """Let the legs slip at a force from the next step on."""
        self.simulation.apply(BrakeLegs(platform="jig/platform", force_n=force_n))

    def push(self, x: float, y: float, z: float) -> None:
        """Push the platform for a second, and see what it does then."""
        push = PushBody(body="jig/platform", force_n=(x, y, z), duration_s=1.0)
        self.simulation.apply(PushSimBody(push=push))
        self.pass_time(1.5)

    def pass_time(self, time_s: float) -> None:
        """Simulate."""
        for _ in range(round(time_s / self.simulation.step_s)):
            self.simulation.step()

    def pose(self, body: str) -> RigidTransform:
        """Return the pose of a body in the world."""
        values = np.zeros(self.simulation.layout.size)
        self.simulation.write_snapshot(values)
        row = self.built.frames.index(body)
        xyz = values[self.simulation.layout.positions].reshape(-1, 3)[row]
        wxyz = values[self.simulation.layout.quaternions].reshape(-1, 4)[row]
        return RigidTransform.of(xyz.copy(), np.roll(wxyz, -1))

    @property
    def moved_mm(self) -> float:
        """How far the platform is from its place at the start."""
        return 1e3 * self.pose("jig/platform").distance_m(self.home)


@pytest.fixture(name="jig")
def _jig(tmp_path: Path) -> Jig:
    return Jig(tmp_path)


def test_a_braked_platform_stands_still(jig: Jig) -> None:
    """It gives way to its weight by hundredths of a millimetre, and does not creep."""
    jig.pass_time(0.5)
    after = jig.moved_mm
    jig.pass_time(10.0)
    assert after < 0.02
    assert jig.moved_mm == pytest.approx(after, abs=1e-4)


def test_braked_legs_hold_less_than_their_force_and_slip_beyond_it(jig: Jig) -> None:
    jig.push(150.0, 0.0, 0.0)
    assert jig.moved_mm < 0.05
    jig.push(0.0, 0.0, -1000.0)
    assert jig.moved_mm < 0.05
    jig.push(2000.0, 0.0, 0.0)
    assert jig.moved_mm > 10.0


def test_released_legs_carry_the_platform_and_give_way_to_a_hand(jig: Jig) -> None:
    jig.brake(FRICTION_N)
    jig.pass_time(3.0)
    assert jig.moved_mm < 0.1
    jig.push(25.0, 0.0, 0.0)
    assert jig.moved_mm > 3.0
    jig.brake(HOLDING_N)
    jig.push(25.0, 0.0, 0.0)
    stands = jig.moved_mm
    jig.pass_time(3.0)
    assert jig.moved_mm == pytest.approx(stands, abs=0.01)


def test_a_platform_that_its_legs_do_not_carry_sinks_to_their_shortest_length(jig: Jig) -> None:
    jig.brake(0.5)
    jig.pass_time(8.0)
    assert jig.moved_mm > 35.0
    lengths = jig.simulation._physics.tendon_lengths  # pyright: ignore[reportPrivateUsage]
    assert lengths.min() == pytest.approx(0.15, abs=0.0005)


def test_what_is_on_the_platform_moves_with_it_and_its_clamp_keeps_its_place_there(jig: Jig) -> None:
    def clamp() -> RigidTransform:
        return jig.pose("jig/platform").inverse().then(jig.pose("jig/clamp"))

    handle = jig.home.inverse().then(jig.pose("jig/handle"))
    jig.simulation.apply(DriveAxis(fixture="jig/clamp", direction=1.0))
    jig.pass_time(2.0)
    closed = clamp()
    jig.brake(FRICTION_N)
    jig.push(20.0, 15.0, 5.0)
    assert jig.moved_mm > 3.0
    assert jig.pose("jig/platform").inverse().then(jig.pose("jig/handle")).distance_m(handle) < 1e-9
    assert clamp().distance_m(closed) < 2e-4


def test_a_restored_world_has_the_platform_where_it_was(jig: Jig) -> None:
    jig.brake(FRICTION_N)
    jig.push(25.0, 0.0, 0.0)
    jig.brake(HOLDING_N)
    jig.pass_time(0.5)
    before = jig.pose("jig/platform")
    image = np.zeros(jig.simulation.image_layout.size)
    jig.simulation.write_image(image)
    other = Simulation(jig.built)
    other.apply(RestoreWorld(image=image))
    jig.simulation = other
    jig.pass_time(2.0)
    assert jig.pose("jig/platform").distance_m(before) < 1e-5


def test_an_unplugged_hexapod_comes_back_as_it_was_left(jig: Jig) -> None:
    jig.brake(FRICTION_N)
    jig.push(25.0, 0.0, 0.0)
    jig.brake(HOLDING_N)
    jig.pass_time(0.5)
    place = cell_as_docked(jig.cell, {"jig": "north"}).fixed_frames["jig"]
    on_module = RigidTransform.from_pose(place).inverse().then(jig.pose("jig/platform"))
    assert jig.simulation.place_module(PlaceModule(module="jig", pose=None)).refused == ""
    jig.pass_time(3.0)
    assert jig.moved_mm > 1e5
    there = cell_as_docked(jig.cell, {"jig": "south"}).fixed_frames["jig"]
    assert jig.simulation.place_module(PlaceModule(module="jig", pose=there)).refused == ""
    jig.pass_time(1.0)
    back = RigidTransform.from_pose(there).inverse().then(jig.pose("jig/platform"))
    assert back.distance_m(on_module) < 5e-5
