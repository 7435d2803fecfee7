"""An emulated Robotiq gripper as a program of its own, and the driver on it."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import AbstractContextManager, asynccontextmanager
from pathlib import Path

import msgspec

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.skills.devices import EnableDevice
from robots.drivers.robotiq.new_robotiq import new_robotiq
from robots.drivers.robotiq.robotiq_gripper import RobotiqGripper
from robots.drivers.robotiq.robotiq_options import RobotiqOptions
from tests.robots.drivers.emulated_device import EmulatedProcess, emulated_device, tool_context

CONNECTIONS = ("modbus_tcp", "rtu_over_tcp", "urcap", "serial")
HAND = "left/gripper"


def emulated(
    connection: str, *, object_m: float | None = None, active: bool = True
) -> AbstractContextManager[EmulatedProcess]:
    """Start an emulator, activated and without a fault of the wire."""
    between = {"object_m": object_m} if object_m is not None else {}
    return emulated_device("robotiq", connection, active=active, activation_s=0.3, **between)


@asynccontextmanager
async def driven(
    emulator: EmulatedProcess, *, enable: bool = False, capture: Path | None = None, **options: float
) -> AsyncGenerator[tuple[SkillBus, RobotiqGripper]]:
    """The driver on an emulator, with its skills on a bus."""
    # A loaded machine gets more time than a cell by default.
    given = {"kind": "robotiq", "connection": emulator.connection, "stale_s": 1.0, "timeout_s": 0.4, **options}
    async with SkillBus(new_clock()) as bus:
        chosen = msgspec.convert(given, RobotiqOptions)
        device = new_robotiq(chosen, name=HAND, clock=bus.clock, context=tool_context(capture))
        async with device:
            device.register(bus)
            if enable:
                await bus.call(EnableDevice(reason="a test"), to=HAND)
            yield bus, device
