"""The shipped conveyor on the bus: it brings a part to its light barrier and stops; what fails has a name."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import PartPoses
from engine.skills.device_moves import DeviceFault, SimulateDeviceFault
from tests.robots.devices.moved_device import move, state

MODULES = Path(__file__).parents[3] / "behaviors" / "modules"
CELL = f"""\
flexcell: 1
cell: bench
world: {{kind: mujoco}}
connectors: {{dock: {{at: {{xyz: [0.5, 0.2, 0], rpy: [0, 0, 1.5707963267948966]}}}}}}
modules: {{conveyor: {{module: {MODULES}/conveyor, connector: dock}}}}
parts:
  crate: {{shape: box, size_m: [0.06, 0.05, 0.04], mass_kg: 0.2, at: {{frame: conveyor/start, xyz: [0, 0, 0.0201]}}}}
"""
DEVICE = "conveyor/belt"

pytestmark = pytest.mark.virtual


@asynccontextmanager
async def opened(folder: Path) -> AsyncGenerator[OpenCell]:
    """Open the cell, in which the module is turned by a quarter: its belt runs along -x."""
    (folder / "cell.yaml").write_text(CELL, encoding="utf-8")
    async with OpenCell(load_cell(folder / "cell.yaml")) as cell:
        yield cell


def crate_along_m(bus: SkillBus) -> float:
    """Return how far the crate has come."""
    parts = bus.topic("cell/parts", PartPoses).latest
    assert parts is not None
    return 0.75 - parts.poses["crate"].xyz[0]


async def test_a_part_is_brought_to_the_light_barrier_and_stops_there(tmp_path: Path) -> None:
    """The barrier is 0.5 m from the start, and the crate 0.05 m long; it stops within 0.025 m."""
    async with opened(tmp_path) as cell:
        bus = cell.bus
        assert (crate_along_m(bus), state(bus, DEVICE).sensors) == (pytest.approx(0.0, abs=1e-6), {"at_end": False})
        assert (await move(bus, DEVICE, "part_at_end")).ended == "reached"
        assert (state(bus, DEVICE).sensors, state(bus, DEVICE).outputs) == ({"at_end": True}, {"belt_run": False})
        await bus.clock.sleep(0.5)
        resting = crate_along_m(bus)
        assert 0.475 < resting < 0.5
        await bus.clock.sleep(1.0)
        assert crate_along_m(bus) == pytest.approx(resting, abs=5e-4)
        assert (await move(bus, DEVICE, "part_at_end")).ended == "reached"
        assert crate_along_m(bus) == pytest.approx(resting, abs=0.01)


@pytest.mark.parametrize("fault", [DeviceFault(stuck="main"), DeviceFault(power=False)], ids=["stuck", "no power"])
async def test_a_belt_that_does_not_run_brings_nothing_and_is_stuck(tmp_path: Path, fault: DeviceFault) -> None:
    async with opened(tmp_path) as cell:
        assert (await cell.bus.call(SimulateDeviceFault(fault=fault), to=DEVICE)).success
        result = await move(cell.bus, DEVICE, "part_at_end")
        assert (result.ended, "at_end is off after 8 s" in result.reason) == ("stuck", True), result.reason
        assert crate_along_m(cell.bus) == pytest.approx(0.0, abs=1e-3)


async def test_it_runs_and_stops_by_time(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        assert (await move(cell.bus, DEVICE, "running")).ended == "timed"
        await cell.bus.clock.sleep(1.0)
        assert (await move(cell.bus, DEVICE, "stopped")).ended == "timed"
        resting = crate_along_m(cell.bus)
        assert 0.12 < resting < 0.19
        await cell.bus.clock.sleep(1.0)
        assert crate_along_m(cell.bus) == pytest.approx(resting, abs=1e-3)
