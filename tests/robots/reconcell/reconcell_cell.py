"""A UR10 in physics behind the interface, and what commands it: the client, and sockets with bytes made by hand."""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import AsyncGenerator, Callable, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.document.cell import load_cell
from engine.robot import Robot
from engine.skills.arm_control import ArmStatus
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.port import ArmPort
from robots.reconcell import InterfaceOptions, ReconcellClient, ReconcellServer
from robots.simulated_cell import new_world
from tests.robots.own_address import own_address
from tests.robots.reconcell.primitives_184 import HOME

CELL = """\
flexcell: 1
cell: one_ur10
world: {kind: mujoco, step_s: 0.002, realism: ideal}
robots:
  ur10: {model: ur10, base: {xyz: [0.1, -0.2, 0.3], rpy: [0, 0, 1.2]}}
"""


class HandMade:
    """A sender that knows nothing of our codec: bytes as the tables of the appendix have them."""

    sent = 0
    """Packets sent by all of them in this test."""

    def __init__(self, server: str) -> None:
        self._server = server
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._socket.close()

    def doubles(self, port: int, *values: float) -> None:
        """Send doubles, eight bytes each, the lowest byte first."""
        self.raw(port, b"".join(struct.pack("<d", value) for value in values))

    def raw(self, port: int, data: bytes) -> None:
        """Send bytes."""
        self._socket.sendto(data, (self._server, port))
        HandMade.sent += 1


@dataclass(frozen=True)
class ReconcellCell:
    """The open cell, its interface, and a client."""

    bus: SkillBus
    port: ArmPort
    server: ReconcellServer
    client: ReconcellClient
    address: str
    robots: Sequence[Robot]

    @property
    def refused(self) -> dict[str, int]:
        """What the interface has refused, by name."""
        return self.server.interface.status.refused

    def joints(self) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
        """The measured joints."""
        return self.port.sample().position_rad.copy()

    def speed_rad_s(self) -> float:
        """The speed of the fastest joint."""
        return float(np.abs(self.port.sample().velocity_rad_s).max())

    async def arrived(self) -> None:
        """Return when everything sent was taken: virtual time does not wait for real sockets by itself."""
        status = self.server.interface.status
        end_s = time.monotonic() + 60.0
        while status.received < self.client.sent + HandMade.sent:
            assert time.monotonic() < end_s, status
            await self.bus.clock.sleep(0.0)
            status = self.server.interface.status

    async def until(self, condition: Callable[[], bool], *, within_s: float = 20.0) -> float:
        """Return the time after which `condition` holds."""
        await self.arrived()
        clock = self.bus.clock
        start_s = clock.now_s()
        while not condition():
            assert clock.now_s() < start_s + within_s, self.server.interface.status
            await clock.sleep(0.01)
        return clock.now_s() - start_s

    async def at_rest(self, *, within_s: float = 20.0) -> None:
        """Return when nothing of the commander is under way, after all packets were read."""
        await self.until(lambda: not self.server.interface.commands.moving, within_s=within_s)

    async def at_rest_now(self) -> None:
        """Return when what was under way has ended."""
        await self.until(lambda: not self.server.interface.commands.moving, within_s=2.0)

    async def stop(self) -> None:
        """Stop as an operator does."""
        for goal in self.bus.goals():
            goal.cancel()
        for robot in self.robots:
            await robot.stop()

    async def receive(self) -> None:
        """Let the client read what is sent from now on; what waited in its sockets is old."""
        await self.arrived()
        self._read_all()
        await self.bus.clock.sleep(0.1)
        self._read_all()

    def _read_all(self) -> None:
        """Read until nothing more comes for a moment."""
        before: object = None
        while (latest := self.client.receive(timeout_s=0.05)) != before:
            before = latest

    def mode(self) -> str:
        """What the arm says it does."""
        latest = self.bus.topic("ur10/status", ArmStatus).latest
        assert latest is not None
        return latest.mode

    async def go_home(self) -> None:
        """Move to `HOME` by the interface."""
        self.client.move_joints(HOME, speed=0.5)
        await self.at_rest()
        assert np.abs(self.joints() - HOME).max() < 0.01


@asynccontextmanager
async def reconcell_cell(
    folder: Path,
    *,
    text: str = CELL,
    address: str = "",
    capture: WireCapture = NO_CAPTURE,
    own_capture: Path | None = None,
    **options: object,
) -> AsyncGenerator[ReconcellCell]:
    """The cell in lockstep with virtual time, its interface at a loopback address of its own."""
    (folder / "cell.yaml").write_text(text, encoding="utf-8")
    address = address or own_address()
    HandMade.sent = 0
    async with AsyncExitStack() as stack:
        bus = await stack.enter_async_context(SkillBus(new_clock()))
        cell = load_cell(folder / "cell.yaml")
        world = await stack.enter_async_context(new_world(cell, bus=bus, virtual=True, seed=None))
        world.register(bus)
        robots = tuple(world.robots())
        for robot in robots:
            await stack.enter_async_context(robot)
            robot.register(bus)
        own = str(own_capture or "")
        chosen = InterfaceOptions(address=address, receivers=(address,), capture=own, **options)  # pyright: ignore[reportArgumentType]
        server = await stack.enter_async_context(ReconcellServer(bus, "ur10", chosen))
        client = stack.enter_context(ReconcellClient(address, own=address, capture=capture))
        yield ReconcellCell(bus, world.arm("ur10"), server, client, address, robots)
