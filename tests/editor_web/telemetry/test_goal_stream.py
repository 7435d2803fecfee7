"""A goal is of who listens to it: when nobody can be told of it, it ends."""

from __future__ import annotations

import asyncio
from contextlib import suppress

import pytest
from starlette.types import Message as Asgi

from editor_web.telemetry.goal_stream import GoalStream
from engine.bus import ActiveGoal, SkillBus
from engine.clock import LoopClock
from engine.messages import Message
from engine.project.bus_inspector import BusInspector
from engine.skill import Action
from tests.editor_web.limits import GUARD_S


class Done(Message, frozen=True, kw_only=True):
    """A result."""


class Go(Action[Done, Done], frozen=True, kw_only=True):
    """Lasts until it is cancelled."""


async def go(request: Go, goal: ActiveGoal[Done]) -> Done:
    goal.accept()
    await asyncio.Event().wait()
    return Done()


async def silence() -> Asgi:
    await asyncio.Event().wait()
    raise AssertionError


@pytest.mark.parametrize("told", [0, 1, 2])
async def test_a_goal_ends_when_its_listener_cannot_be_notified(told: int) -> None:
    """Also where not even the first line goes out, before anybody waits for the end."""
    lines = 0

    async def send(message: Asgi) -> None:
        nonlocal lines
        lines += 1
        if lines > told:
            raise OSError("the line is cut")

    async with SkillBus(LoopClock()) as bus:
        bus.advertise_action(Go, go, namespace="arm")
        inspector = BusInspector(bus)
        handle = inspector.send("arm/go", {})
        async with asyncio.timeout(GUARD_S):
            with suppress(OSError):
                await GoalStream(inspector, handle)({"type": "http"}, silence, send)
        assert handle.finished
        assert bus.leases.held() == ()
