"""A jogger lets go of its arm, and only when that rests, however its page goes."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from editor_web.teaching.jogging import Jogger
from editor_web.teaching.teaching_messages import StartJog
from engine.bus import GoalHandle
from engine.errors import BusError
from engine.skills.goal_end import GoalEnd
from tests.editor_web.fake_backend import TopicBus

JOG = StartJog(arm="left", space="joints")


class BrakingArm(TopicBus):
    """Jogs until it is cancelled, and rests when the test lets it."""

    def __init__(self) -> None:
        super().__init__({})
        self.moving = asyncio.Event()
        self.may_rest = asyncio.Event()
        self.rested = False

    async def perform(
        self, address: str, goal: object, *, on_sent: Callable[[GoalHandle[Any, Any]], None] | None = None
    ) -> GoalEnd[Any]:
        self.moving.set()
        try:
            await asyncio.Event().wait()
        finally:
            await self.may_rest.wait()
            self.rested = True
        raise BusError("never", where=address)


async def test_an_arm_whose_page_goes_before_it_was_jogged_is_free_for_the_next() -> None:
    taken: dict[str, Jogger] = {}
    arm = BrakingArm()
    jogger = Jogger(arm, taken=taken, send=lambda _: None)

    async def page() -> None:
        await jogger.begin(JOG)
        await jogger.rest()

    here = asyncio.create_task(page())
    await asyncio.sleep(0)
    here.cancel()
    await asyncio.wait({here})
    await jogger.rest()
    assert (taken, jogger.arm, arm.moving.is_set()) == ({}, "", False)


async def test_who_asks_again_for_rest_waits_until_the_arm_rests() -> None:
    """The page's own message was cut short by the end of its connection; the arm brakes meanwhile."""
    taken: dict[str, Jogger] = {}
    arm = BrakingArm()
    jogger = Jogger(arm, taken=taken, send=lambda _: None)
    await jogger.begin(JOG)
    await arm.moving.wait()
    first = asyncio.create_task(jogger.rest())
    await asyncio.sleep(0)
    first.cancel()
    with pytest.raises(asyncio.CancelledError):
        await first
    again = asyncio.create_task(jogger.rest())
    await asyncio.sleep(0)
    assert not again.done()
    assert taken == {"left": jogger}
    arm.may_rest.set()
    await again
    assert (taken, arm.rested) == ({}, True)
