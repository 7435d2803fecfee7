"""How a person permits a real device to act: the service that asks for it, and the line in the log."""

from __future__ import annotations

import logging
from typing import Protocol

from engine.bus import SkillBus
from engine.errors import GoalRejected
from engine.messages.device_state import DeviceState
from engine.skills.devices import EnableDevice
from robots.drivers.device_history import one_line

_log = logging.getLogger("flexcell.devices")


class EnabledByPerson(Protocol):
    """A device that acts only after a person has enabled it."""

    async def enable(self, reason: str, *, by: str = "") -> None:
        """Permit it to act; raises RobotError where it cannot."""
        ...

    def device_state(self) -> DeviceState:
        """Return whether it answers and may act."""
        ...


def advertise_enabling(bus: SkillBus, name: str, device: EnabledByPerson) -> None:
    """Advertise `EnableDevice`, which rejects the request while a run commands the device."""

    async def enable(request: EnableDevice) -> DeviceState:
        owner = bus.leases.owner(name)
        if owner is not None:
            raise GoalRejected(f"{name} is commanded by run {owner}", hint="end that run first")
        await device.enable(request.reason, by=request.by)
        return device.device_state()

    bus.advertise_service(EnableDevice, enable, namespace=name)


def log_enabling(name: str, *, by: str, reason: str) -> None:
    """Log that a person enables a device, before it may act."""
    _log.warning("%s is enabled by %s: %s", name, one_line(by) or "a person who gave no name", one_line(reason))
