"""The driver of the Franka Hand on an emulated robot, with its skills on a bus."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import AbstractContextManager, asynccontextmanager
from pathlib import Path

import msgspec

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.skills.devices import EnableDevice
from robots.drivers.franka_hand.franka_hand import FrankaHand
from robots.drivers.franka_hand.franka_hand_options import FrankaHandOptions
from robots.drivers.franka_hand.new_franka_hand import new_franka_hand
from tests.robots.drivers.emulated_device import EmulatedProcess, tool_context
from tests.robots.drivers.emulated_gripper import HAND
from tests.robots.drivers.franka.emulated_cabinet import emulated_cabinet

FRANKA_HAND_CONNECTIONS = ("fci",)


def emulated_franka_hand(connection: str) -> AbstractContextManager[EmulatedProcess]:
    """Start an emulated robot whose hand is homed."""
    assert connection in FRANKA_HAND_CONNECTIONS
    return emulated_cabinet()


@asynccontextmanager
async def driven_franka_hand(
    emulator: EmulatedProcess, *, enable: bool = False, capture: Path | None = None, **options: float
) -> AsyncGenerator[tuple[SkillBus, FrankaHand]]:
    """The driver on an emulator; a loaded machine gets more time than a cell by default."""
    given = {
        "kind": "franka_hand",
        "host": emulator.place["host"],
        "stale_s": 2.0,
        "timeout_s": 1.0,
        "patience_s": 30.0,
        **options,
    }
    async with SkillBus(new_clock()) as bus:
        device = new_franka_hand(
            msgspec.convert(given, FrankaHandOptions), name=HAND, clock=bus.clock, context=tool_context(capture)
        )
        async with device:
            device.register(bus)
            if enable:
                await bus.call(EnableDevice(reason="a test"), to=HAND)
            yield bus, device
