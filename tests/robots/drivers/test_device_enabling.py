"""How a person permits a device to act: not while a run commands it, and as one line of the log."""

from __future__ import annotations

import logging

import pytest

from engine.bus import Holder, SkillBus
from engine.clock import new_clock
from engine.errors import GoalRejected
from engine.messages.device_state import DeviceState
from engine.skills.devices import EnableDevice
from robots.drivers.device_enabling import advertise_enabling, log_enabling

pytestmark = pytest.mark.virtual


class Device:
    """Notes who has enabled it."""

    def __init__(self) -> None:
        self.enabled_by: list[tuple[str, str]] = []

    async def enable(self, reason: str, *, by: str = "") -> None:
        """Note it."""
        self.enabled_by.append((by, reason))

    def device_state(self) -> DeviceState:
        """Return whether somebody has enabled it."""
        return DeviceState(
            driver="robotiq", address="here:1", connected=True, enabled=bool(self.enabled_by), problem=""
        )


async def test_a_device_that_a_run_commands_is_not_enabled() -> None:
    bus, device = SkillBus(new_clock()), Device()
    advertise_enabling(bus, "arm", device)
    bus.leases.acquire(["arm"], Holder(run="run-1"))
    with pytest.raises(GoalRejected, match="arm is commanded by run run-1"):
        await bus.call(EnableDevice(reason="the cell is clear", by="ann"), to="arm")
    assert device.enabled_by == []
    bus.leases.release_run("run-1")
    assert (await bus.call(EnableDevice(reason="the cell is clear", by="ann"), to="arm")).enabled
    assert device.enabled_by == [("ann", "the cell is clear")]


def test_a_reason_with_line_ends_is_one_line_of_the_log(caplog: pytest.LogCaptureFixture) -> None:
    """Else whoever may enable a device could write any line."""
    by, reason = "eve\r\nERROR arm", "looked\n2026-11-27 INFO all is well\u2028\x85\x1b[2Jok"
    with caplog.at_level(logging.WARNING, logger="flexcell.devices"):
        log_enabling("arm", by=by, reason=reason)
    assert caplog.messages == ["arm is enabled by eve ERROR arm: looked 2026-11-27 INFO all is well [2Jok"]
