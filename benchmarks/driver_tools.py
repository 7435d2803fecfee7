"""Tools behind their drivers, with their emulators, for the benchmark of drivers: one table of what differs."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncGenerator, Callable, Mapping
from contextlib import AbstractAsyncContextManager, AbstractContextManager, asynccontextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

from benchmarks.driver_figures import Figures, until
from engine.bus import SkillBus
from engine.skills.devices import EnableDevice
from robots.drivers.tool_device import ToolDevice
from robots.port import GripperPort, HandPort, Motion
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.emulated_gripper import driven, emulated
from tests.robots.drivers.emulated_hand import driven_hand, emulated_hand
from tests.robots.drivers.franka_hand.emulated_franka_hand import driven_franka_hand, emulated_franka_hand

_CREEPS = 1e-4


class FingerMotions:
    """Two fingers, by the widths and speeds of their port."""

    def __init__(self, port: GripperPort, *, close_m_s: float, open_m_s: float, force_n: float) -> None:
        self._port = port
        self._close_m_s, self._open_m_s, self._force_n = close_m_s, open_m_s, force_n

    def close(self) -> Motion:
        """Close fully."""
        return self._port.close_to(width_m=0.0, speed_m_s=self._close_m_s, force_n=self._force_n)

    def open(self) -> Motion:
        """Open fully."""
        port = self._port
        return port.close_to(width_m=port.max_width_m, speed_m_s=self._open_m_s, force_n=self._force_n)

    def closed_share(self) -> float:
        """Return the measured share, 0 open to 1 closed."""
        return 1.0 - self._port.sample().width_m / self._port.max_width_m


class TendonMotions:
    """A hand with one motor, by the times of its port."""

    def __init__(self, port: HandPort, *, close_s: float, open_s: float) -> None:
        self._port = port
        self._close_s, self._open_s = close_s, open_s

    def close(self) -> Motion:
        """Close fully."""
        return self._port.close_to(share=1.0, time_s=self._close_s)

    def open(self) -> Motion:
        """Open fully."""
        return self._port.close_to(share=0.0, time_s=self._open_s)

    def closed_share(self) -> float:
        """Return the measured share, 0 open to 1 closed."""
        return self._port.sample().closed_share


@dataclass(frozen=True, kw_only=True)
class Tool:
    """An open tool that may move, and its emulator."""

    motions: FingerMotions | TendonMotions
    device: ToolDevice[Any, Any, Any]
    bus: SkillBus
    emulator: EmulatedProcess

    def reads(self) -> bool:
        """Return whether its driver reads."""
        return self.device.device_state().connected

    async def accept(self) -> None:
        """Connect it again after a loss, and permit motion."""
        await self.device.reconnect()
        await self.bus.call(EnableDevice(reason="a benchmark"), to=self.device.name)


_Driven = Callable[..., AbstractAsyncContextManager[tuple[SkillBus, ToolDevice[Any, Any, Any]]]]


@asynccontextmanager
async def _opened(
    emulating: AbstractContextManager[EmulatedProcess],
    driving: _Driven,
    new_motions: Callable[[Any], FingerMotions | TendonMotions],
) -> AsyncGenerator[Tool]:
    with emulating as emulator:
        async with driving(emulator, enable=True) as (bus, device):
            yield Tool(motions=new_motions(device.port), device=device, bus=bus, emulator=emulator)


TOOLS: Mapping[str, Callable[[], AbstractAsyncContextManager[Tool]]] = {
    "Robotiq 2F-85": lambda: _opened(
        emulated("modbus_tcp"), driven, partial(FingerMotions, close_m_s=0.05, open_m_s=0.15, force_n=60.0)
    ),
    "SoftHand": lambda: _opened(emulated_hand("tcp"), driven_hand, partial(TendonMotions, close_s=1.7, open_s=1.0)),
    "Franka Hand": lambda: _opened(
        emulated_franka_hand("fci"),
        driven_franka_hand,
        partial(FingerMotions, close_m_s=0.05, open_m_s=0.1, force_n=20.0),
    ),
}
"""By name: a 2F-85 over Modbus TCP, a SoftHand over a socket as a serial line, the hand of an FR3 of franky-sim."""


async def measure_tool(name: str, tool: Tool, rounds: int) -> Figures:
    """Measure one tool."""
    figures = Figures(arm=name)
    for _ in range(rounds):
        await _open(tool)
        await _start_and_cancel(tool, figures)
        await _open(tool)
        await _lose_link(tool, figures)
    return figures


async def _open(tool: Tool) -> None:
    report = await tool.motions.open().report()
    if report.reason:
        raise SystemExit(f"the tool did not open: {report.reason}")


async def _start_and_cancel(tool: Tool, figures: Figures) -> None:
    before, commanded_s = tool.motions.closed_share(), time.perf_counter()
    motion = tool.motions.close()
    await until(lambda: tool.motions.closed_share() > before + 0.005)
    figures.start_s.append(time.perf_counter() - commanded_s)
    await until(lambda: tool.motions.closed_share() > 0.3)
    cancelled_s = time.perf_counter()
    motion.cancel()
    await motion.report()
    figures.cancel_s.append(time.perf_counter() - cancelled_s)


async def _lose_link(tool: Tool, figures: Figures) -> None:
    motion = tool.motions.close()
    await until(lambda: tool.motions.closed_share() > 0.2)
    cut_s = time.perf_counter()
    tool.emulator.do("cut")
    resting = asyncio.create_task(asyncio.to_thread(_rest, tool.emulator, cut_s))
    await until(lambda: not tool.reads())
    figures.cut_named_s.append(time.perf_counter() - cut_s)
    figures.cut_rest_s.append(await resting)
    await motion.report()
    tool.emulator.do("restore")
    restored_s = time.perf_counter()
    await until(tool.reads)
    figures.reading_again_s.append(time.perf_counter() - restored_s)
    await tool.accept()


def _rest(emulator: EmulatedProcess, cut_s: float) -> float:
    """Return how long after the cut the fingers rest: they do when they have gone no further for a moment."""
    travel, since_s = -1.0, time.perf_counter()
    while (now_s := time.perf_counter()) - since_s < 0.2:
        latest = float(emulator.do("state")["travel"])
        # Simulated fingers creep.
        if abs(latest - travel) > _CREEPS:
            travel, since_s = latest, now_s
    return since_s - cut_s
