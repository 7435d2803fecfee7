"""Plans in worker threads: one at a time uses the kinematics, also after its goal was cancelled."""

from __future__ import annotations

import asyncio
import threading

import pytest

from engine.clock import new_clock
from robots.arm.execution.arm_planner import ArmPlanner
from robots.model.mechanics.kinematics import ArmKinematics
from tests.robots.panda_arm import panda_kinematics


async def _loaded() -> None:
    """Nothing is to be loaded."""


async def test_a_plan_waits_for_the_thread_of_a_plan_that_nobody_waits_for_any_more() -> None:
    planner = ArmPlanner(panda_kinematics().twin(), clock=new_clock(), loaded=_loaded)
    using: list[int] = []
    begun, go_on = threading.Event(), threading.Event()

    def slow(_: ArmKinematics) -> None:
        using.append(1)
        begun.set()
        go_on.wait(30.0)
        using.remove(1)

    abandoned = asyncio.ensure_future(planner.make(slow))
    assert await asyncio.to_thread(begun.wait, 30.0)
    abandoned.cancel()
    with pytest.raises(asyncio.CancelledError):
        await abandoned
    second = asyncio.ensure_future(planner.make(lambda _: tuple(using)))
    done, _ = await asyncio.wait({second}, timeout=0.05)
    assert not done
    go_on.set()
    assert await second == ()
