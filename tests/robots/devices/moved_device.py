"""A device of an open cell on the bus: moved to a position, and what is known of it."""

from __future__ import annotations

from engine.bus import GoalStatus, SkillBus
from engine.skills.device_moves import DeviceReading, DeviceResult, MoveDevice


async def move(bus: SkillBus, device: str, position: str) -> DeviceResult:
    """Move a device and return how that ended."""
    end = await bus.send_goal(MoveDevice(position=position), to=device).result()
    assert (end.status, end.cause) == (GoalStatus.SUCCEEDED, None)
    assert end.result is not None
    return end.result


def state(bus: SkillBus, device: str) -> DeviceReading:
    """Return what is known of a device."""
    found = bus.topic(f"{device}/state", DeviceReading).latest
    assert found is not None
    return found
