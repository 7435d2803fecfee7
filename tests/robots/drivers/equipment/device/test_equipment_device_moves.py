"""A device on real pins: nothing moves before a person permits it, sensors end a motion, a lost server is its cause."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.bus import GoalEnd, GoalStatus, SkillBus
from engine.cell.open_cell import OpenCell
from engine.skills.device_moves import DeviceReading, DeviceResult, MoveDevice
from tests.robots.drivers.emulated_device import emulated_device
from tests.robots.drivers.equipment.device.equipment_cell import opened, outputs, until, written
from tests.robots.drivers.equipment.served_equipment import PINS, served_equipment

VALVE, THERE = 22, 27
DEVICES = """\
fixtures:
  jaw: {shape: box, size_m: [0.02, 0.08, 0.04], at: {xyz: [0, 0, 0.1]}}
devices:
  clamp_jaw:
    equipment: vice
    axes:
      main: {body: jaw, joint: slide, along: [1, 0, 0], stroke_m: 0.05, force_n: 60, speed_m_s: 0.05, output: valve}
    sensors:
      there: {axis: main, at_least: 0.02}
    positions:
      open: {steps: [{set: {valve: false}}], sensors: {there: false}, time: 20}
      closed: {steps: [{set: {valve: true}}], sensors: {there: true}, time: 20}
"""


async def moved(bus: SkillBus, position: str) -> GoalEnd[DeviceResult]:
    """Move the device and return how that ended."""
    return await bus.send_goal(MoveDevice(position=position), to="clamp_jaw").result()


def reading(bus: SkillBus) -> DeviceReading:
    """Return what is known of the device."""
    found = bus.topic("clamp_jaw/state", DeviceReading).latest
    assert found is not None
    return found


async def enabled(cell: OpenCell) -> None:
    """Permit outputs."""
    await cell.enable("a test", by="a test")


@pytest.mark.parametrize("world", ["", "world: {kind: mujoco}\n"])
async def test_its_pins_are_set_and_its_sensor_ends_the_motion(tmp_path: Path, world: str) -> None:
    """In a cell with a world too: the inputs are those of the pins and not of the simulated jaw."""
    with emulated_device("pigpiod") as pigpiod:
        place = pigpiod.place
        backend = f"{{kind: gpiozero, factory: pigpio, host: {place['host']}, port: {place['port']}}}"
        pins = f"flexcell: 1\nequipment: clamps\nbackend: {backend}\n{PINS}"
        (tmp_path / "served.yaml").write_text(pins, encoding="utf-8")
        with served_equipment(tmp_path / "served.yaml") as server:
            file = written(tmp_path, host=server.host, port=server.port, pins=pins)
            file.write_text(file.read_text(encoding="utf-8") + DEVICES + world, encoding="utf-8")
            async with opened(file) as cell:
                refused = await moved(cell.bus, "closed")
                assert refused.status is GoalStatus.ABORTED
                assert refused.cause is not None
                assert "the output valve was not set" in refused.cause.chain()[-1].message
                assert "not enabled" in refused.cause.chain()[-1].message
                assert pigpiod.do("state", pin=VALVE)["level"] == 0
                await enabled(cell)
                moving = asyncio.create_task(moved(cell.bus, "closed"))
                await until(lambda: pigpiod.do("state", pin=VALVE)["level"] == 1)
                pigpiod.do("level", pin=THERE, on=True)
                ended = await moving
                assert ended.result is not None
                assert (ended.result.ended, reading(cell.bus).sensed) == ("reached", "closed")
                assert reading(cell.bus).outputs == {"valve": True}


async def test_a_server_that_is_lost_in_the_middle_is_the_cause(tmp_path: Path) -> None:
    pins = f"flexcell: 1\nequipment: clamps\nbackend: {{kind: simulated}}\n{PINS}"
    (tmp_path / "served.yaml").write_text(pins, encoding="utf-8")
    with served_equipment(tmp_path / "served.yaml") as server:
        file = written(tmp_path, host=server.host, port=server.port, pins=pins)
        file.write_text(file.read_text(encoding="utf-8") + DEVICES, encoding="utf-8")
        async with opened(file) as cell:
            await enabled(cell)
            moving = asyncio.create_task(moved(cell.bus, "closed"))
            await until(lambda: outputs(cell.bus)["valve"])
            server.process.kill()
            ended = await moving
            assert ended.status is GoalStatus.ABORTED
            assert ended.cause is not None
            assert "vice at " in ended.cause.chain()[-1].message
            assert reading(cell.bus).problem
