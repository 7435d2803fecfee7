"""An emulated SoftHand as a program of its own, and the driver on it."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import AbstractContextManager, asynccontextmanager
from pathlib import Path

import msgspec

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.skills.devices import EnableDevice
from robots.drivers.softhand.new_softhand import new_softhand
from robots.drivers.softhand.softhand import SoftHand
from robots.drivers.softhand.softhand_options import SoftHandOptions
from tests.robots.drivers.emulated_device import EmulatedProcess, emulated_device, tool_context

HAND_CONNECTIONS = ("tcp", "serial")
HAND = "left/hand"


def emulated_hand(connection: str, *, active: bool = True) -> AbstractContextManager[EmulatedProcess]:
    """Start an emulator, activated and without a fault of the wire."""
    return emulated_device("softhand", connection, active=active)


@asynccontextmanager
async def driven_hand(
    emulator: EmulatedProcess, *, enable: bool = False, capture: Path | None = None, **options: float
) -> AsyncGenerator[tuple[SkillBus, SoftHand]]:
    """The driver on an emulator, with its skills on a bus."""
    # A loaded machine gets more time than a cell by default.
    given = {"kind": "softhand", "device": emulator.serial_device, "stale_s": 1.0, "timeout_s": 0.4, **options}
    async with SkillBus(new_clock()) as bus:
        chosen = msgspec.convert(given, SoftHandOptions)
        device = new_softhand(chosen, name=HAND, clock=bus.clock, context=tool_context(capture))
        async with device:
            device.register(bus)
            if enable:
                await bus.call(EnableDevice(reason="a test"), to=HAND)
            yield bus, device
