"""Guided motion of the emulated controller: what is measured is its plant, in the time of its plant."""

from __future__ import annotations

import asyncio
import socket

import numpy as np

from robots.drivers.abb.egm.egm_messages import EgmSetPoint, MciState, decode_measurement, encode_set_point
from robots.drivers.abb.emulation.controller_panel import ControllerPanel
from robots.drivers.abb.emulation.egm_source import EgmSource
from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.emulation.wire_faults import WireFaults
from robots.port import Array

HOST = "127.0.0.1"
STEP_S = 0.004


class LaggingAxes:
    """Implements `ArmPlant`: half of the way to the set point in each cycle."""

    problem = ""

    def __init__(self) -> None:
        self.position: Array = np.zeros(6)

    def follow(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Go half of the way."""
        self.position = 0.5 * (self.position + position_rad)

    def carry(self, mass_kg: float) -> None:
        """Weigh nothing."""

    def measured(self) -> tuple[Array, Array]:
        """Return where they are."""
        return self.position, np.zeros(6)

    def reset(self) -> None:
        """There is no problem."""


class SteppedClock:
    """Implements `PlantClock`: time passes when the test says so, and for everyone who waits."""

    def __init__(self) -> None:
        self._now_s = 0.0
        self._passed = asyncio.Event()

    def now_s(self) -> float:
        """Return the time."""
        return self._now_s

    async def sleep_until(self, time_s: float) -> None:
        """Wait for the test."""
        while self._now_s < time_s - 1e-9:
            await self._passed.wait()

    def step(self) -> None:
        """Let a cycle pass."""
        self._now_s += STEP_S
        self._passed.set()
        self._passed = asyncio.Event()


async def test_measured_are_the_axes_of_the_plant_and_planned_what_they_were_sent() -> None:
    clock, plant = SteppedClock(), LaggingAxes()
    controller = EmulatedController(clock.now_s, axes=np.zeros(6), stop_s=0.2, plant=plant)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as driver:
        driver.bind((HOST, 0))
        driver.setblocking(False)
        source = EgmSource(
            controller,
            ControllerPanel(controller),
            WireFaults(),
            client=driver.getsockname(),
            clock=clock,
            stop_s=0.2,
            comm_timeout_s=10.0,
        )
        await source.open(HOST)
        try:
            await asyncio.sleep(0.0)
            loop = asyncio.get_running_loop()
            running, sender = False, (HOST, 0)
            while not running:
                # The program begins after a pause.
                clock.step()
                packet, sender = await loop.sock_recvfrom(driver, 4096)
                running = decode_measurement(packet).mci is MciState.RUNNING
            goal = (0.4, 0.0, 0.0, 0.0, 0.0, 0.0)
            # A machine that is late finds many that wait, and garbage among them.
            for number, angle in enumerate((7.0, 5.0, 3.0, goal[0])):
                waiting = EgmSetPoint(number=number, time_ms=number, planned_deg=(angle, *goal[1:]))
                driver.sendto(encode_set_point(waiting), sender)
                driver.sendto(b"no set point", sender)
            clock.step()
            first = decode_measurement(await loop.sock_recv(driver, 4096))
            assert first.planned_deg == goal
            assert np.allclose(first.measured_deg, (0.2, 0, 0, 0, 0, 0))
            clock.step()
            second = decode_measurement(await loop.sock_recv(driver, 4096))
            assert np.allclose(second.measured_deg, (0.3, 0, 0, 0, 0, 0))
            assert (second.number - first.number, second.time_ms - first.time_ms) == (1, 4)
        finally:
            source.close()
