"""A tool on a transport in memory: what happens while a person enables it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import replace

import pytest

from engine.cell.drivers import DeviceReport
from engine.clock import new_clock
from engine.errors import RobotError
from robots.drivers.fresh_link import LinkTiming
from robots.drivers.robotiq.gripper_registers import ActivationStatus, GripperCommand, GripperStatus, ObjectStatus
from robots.drivers.robotiq.robotiq_gripper import RobotiqGripper
from robots.io.wire.link_error import LinkError

TIMING = LinkTiming(period_s=0.005, stale_s=0.2)


class Transport:
    """A gripper that activates when the test says so; its line is cut while `is_cut`."""

    address = "nowhere:1"
    remedy = "check the fake"

    def __init__(self) -> None:
        self.is_cut = False
        self.status = GripperStatus(
            activated=False,
            go=False,
            activation=ActivationStatus.RESET,
            contact=ObjectStatus.MOVING,
            fault=0,
            position_echo=0,
            position=0,
            current_a=0.0,
        )

    def open(self) -> None:
        self._check()

    def close(self) -> None:
        """There is nothing to close."""

    def read(self) -> GripperStatus:
        self._check()
        return self.status

    def write(self, command: GripperCommand) -> None:
        self._check()
        self.status = replace(self.status, activated=command.activate)

    def activate(self) -> None:
        self.status = replace(self.status, activation=ActivationStatus.ACTIVE)

    def _check(self) -> None:
        if self.is_cut:
            raise LinkError("cut")


@asynccontextmanager
async def activating(transport: Transport) -> AsyncGenerator[tuple[RobotiqGripper, asyncio.Task[None]]]:
    """A gripper whose fingers move because a person enables it."""
    about = DeviceReport(device="hand", driver="robotiq", address="nowhere:1")
    clock = new_clock()
    gripper = RobotiqGripper("hand", transport, timing=TIMING, widths=((0, 0.085), (255, 0.0)), about=about)
    async with gripper:
        enabling = asyncio.create_task(gripper.enable("a test"))
        while not transport.status.activated:
            await clock.sleep(0.01)
        yield gripper, enabling


async def test_stop_ends_an_activation_and_the_tool_is_not_enabled() -> None:
    transport = Transport()
    async with activating(transport) as (gripper, enabling):
        await gripper.stop()
        assert not transport.status.activated
        with pytest.raises(RobotError, match="was stopped while it was enabled"):
            await enabling
        transport.activate()
        assert not gripper.device_state().enabled


async def test_an_activation_is_stopped_while_the_event_loop_is_silent() -> None:
    transport = Transport()
    async with activating(transport) as (_, enabling):
        ends_s = time.monotonic() + 20.0
        while transport.status.activated and time.monotonic() < ends_s:
            pass
        assert not transport.status.activated
        enabling.cancel()


async def test_a_tool_that_is_closed_while_it_is_activated_is_stopped() -> None:
    transport = Transport()
    async with activating(transport) as (_, enabling):
        assert not enabling.done()
    assert not transport.status.activated
    with pytest.raises(RobotError, match="was stopped while it was enabled"):
        await enabling


async def test_one_person_at_a_time_enables_a_tool() -> None:
    transport = Transport()
    async with activating(transport) as (gripper, enabling):
        with pytest.raises(RobotError, match="is being enabled already"):
            await gripper.enable("another")
        transport.activate()
        await enabling
        assert gripper.device_state().enabled


async def test_a_tool_whose_line_was_cut_while_it_was_activated_is_not_enabled() -> None:
    transport, clock = Transport(), new_clock()
    async with activating(transport) as (gripper, enabling):
        transport.is_cut = True
        while not gripper.lost_reason:
            await clock.sleep(0.01)
        transport.is_cut = False
        while gripper.device_state().connected is False:
            await clock.sleep(0.01)
        await gripper.reconnect()
        transport.activate()
        with pytest.raises(RobotError, match="the connection was lost meanwhile"):
            await enabling
        assert "motion was not permitted since" in gripper.device_state().problem
        await gripper.enable("again")
        assert gripper.device_state().enabled
