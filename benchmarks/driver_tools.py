"""A gripper and a hand behind their drivers, with their emulators, for the benchmark of drivers."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncGenerator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass

from benchmarks.driver_figures import Figures, until
from engine.skills.devices import EnableDevice
from robots.port import Motion
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.emulated_gripper import HAND as GRIPPER
from tests.robots.drivers.emulated_gripper import driven, emulated
from tests.robots.drivers.emulated_hand import HAND, driven_hand, emulated_hand
from tests.robots.drivers.franka_hand.emulated_franka_hand import driven_franka_hand, emulated_franka_hand

_CREEPS = 1e-4


@dataclass(frozen=True, kw_only=True)
class Tool:
    """An open tool that may move; `closed` is its measured share, 0 open to 1 closed."""

    close: Callable[[], Motion]
    open: Callable[[], Motion]
    closed: Callable[[], float]
    reads: Callable[[], bool]
    reconnect: Callable[[], Awaitable[object]]
    enable: Callable[[], Awaitable[object]]
    emulator: EmulatedProcess


@asynccontextmanager
async def robotiq() -> AsyncGenerator[Tool]:
    """Yield a 2F-85 over Modbus TCP."""
    with emulated("modbus_tcp") as emulator:
        async with driven(emulator, enable=True) as (bus, device):
            port = device.port
            widest_m = port.max_width_m
            yield Tool(
                close=lambda: port.close_to(width_m=0.0, speed_m_s=0.05, force_n=60.0),
                open=lambda: port.close_to(width_m=widest_m, speed_m_s=0.15, force_n=60.0),
                closed=lambda: 1.0 - port.sample().width_m / widest_m,
                reads=lambda: device.device_state().connected,
                reconnect=device.reconnect,
                enable=lambda: bus.call(EnableDevice(reason="a benchmark"), to=GRIPPER),
                emulator=emulator,
            )


@asynccontextmanager
async def softhand() -> AsyncGenerator[Tool]:
    """Yield a SoftHand over a socket as a serial line."""
    with emulated_hand("tcp") as emulator:
        async with driven_hand(emulator, enable=True) as (bus, device):
            port = device.port
            yield Tool(
                close=lambda: port.close_to(share=1.0, time_s=1.7),
                open=lambda: port.close_to(share=0.0, time_s=1.0),
                closed=lambda: port.sample().closed_share,
                reads=lambda: device.device_state().connected,
                reconnect=device.reconnect,
                enable=lambda: bus.call(EnableDevice(reason="a benchmark"), to=HAND),
                emulator=emulator,
            )


@asynccontextmanager
async def franka_hand() -> AsyncGenerator[Tool]:
    """Yield the hand of an FR3 of franky-sim."""
    with emulated_franka_hand("fci") as emulator:
        async with driven_franka_hand(emulator, enable=True) as (bus, device):
            port = device.port
            widest_m = port.max_width_m
            yield Tool(
                close=lambda: port.close_to(width_m=0.0, speed_m_s=0.05, force_n=20.0),
                open=lambda: port.close_to(width_m=widest_m, speed_m_s=0.1, force_n=20.0),
                closed=lambda: 1.0 - port.sample().width_m / widest_m,
                reads=lambda: device.device_state().connected,
                reconnect=device.reconnect,
                enable=lambda: bus.call(EnableDevice(reason="a benchmark"), to=GRIPPER),
                emulator=emulator,
            )


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
    report = await tool.open().report()
    if report.reason:
        raise SystemExit(f"the tool did not open: {report.reason}")


async def _start_and_cancel(tool: Tool, figures: Figures) -> None:
    before, commanded_s = tool.closed(), time.perf_counter()
    motion = tool.close()
    await until(lambda: tool.closed() > before + 0.005)
    figures.start_s.append(time.perf_counter() - commanded_s)
    await until(lambda: tool.closed() > 0.3)
    cancelled_s = time.perf_counter()
    motion.cancel()
    await motion.report()
    figures.cancel_s.append(time.perf_counter() - cancelled_s)


async def _lose_link(tool: Tool, figures: Figures) -> None:
    motion = tool.close()
    await until(lambda: tool.closed() > 0.2)
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
    await tool.reconnect()
    await tool.enable()


def _rest(emulator: EmulatedProcess, cut_s: float) -> float:
    """Return how long after the cut the fingers rest: they do when they have gone no further for a moment."""
    travel, since_s = -1.0, time.perf_counter()
    while (now_s := time.perf_counter()) - since_s < 0.2:
        latest = float(emulator.do("state")["travel"])
        # Simulated fingers creep.
        if abs(latest - travel) > _CREEPS:
            travel, since_s = latest, now_s
    return since_s - cut_s
