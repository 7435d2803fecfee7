"""The time of an emulated cell: real time where the machine can, and one time for the world and its controllers."""

from __future__ import annotations

import asyncio
import time
from typing import Any, cast

import pytest

from robots.drivers.cell_emulation.world_time import WorldTime


class SlowWorld:
    """A world whose steps take so many times their duration."""

    def __init__(self, slowness: float) -> None:
        self._slowness = slowness

    def advance(self, until_s: float) -> float:
        until = time.monotonic() + self._slowness * 0.004
        while time.monotonic() < until:
            pass
        return until_s


async def slept(slowness: float, duration_s: float) -> tuple[float, float, float]:
    """Sleep in the time of a world; return what passed there, in reality, and how late the world is."""
    world = WorldTime(cast("Any", SlowWorld(slowness)))
    running = asyncio.create_task(world.run())
    real_s, world_s = time.monotonic(), world.now_s()
    await world.sleep_until(world_s + duration_s)
    passed = world.now_s() - world_s, time.monotonic() - real_s, world.late_s
    running.cancel()
    await asyncio.wait((running,))
    return passed


def test_a_world_is_not_faster_than_real_time() -> None:
    there_s, real_s, _ = asyncio.run(slept(0.0, 0.2))
    assert there_s == pytest.approx(0.2, abs=0.005)
    assert real_s > 0.19


def test_controllers_of_a_slow_world_wait_for_it_and_it_says_how_late_it_is() -> None:
    there_s, real_s, late_s = asyncio.run(slept(4.0, 0.2))
    assert there_s == pytest.approx(0.2, abs=0.005)
    assert real_s > 0.75
    assert late_s == pytest.approx(real_s - there_s - 0.1, abs=0.05)


def test_a_time_that_has_passed_gives_others_their_turn() -> None:
    async def main() -> list[str]:
        world = WorldTime(cast("Any", SlowWorld(0.0)))
        order: list[str] = []
        asyncio.get_running_loop().call_soon(order.append, "others")
        await world.sleep_until(world.now_s() - 1.0)
        return [*order, "back"]

    assert asyncio.run(main()) == ["others", "back"]
