"""Which answer of the world belongs to which hold or resume."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import Any

import pytest

from robots.control.commanding.motion_registry import CommandedMotion
from robots.control.motion_event import MotionFinished, MotionHeld, MotionResumed
from robots.port import MotionEnd, MotionReport
from robots.sim.commands.world_commands import AnyCommand


class Asked:
    """A motion whose commands go nowhere, and the holds and resumes asked of it."""

    def __init__(self) -> None:
        self.sent: list[AnyCommand] = []
        self.motion = CommandedMotion(7, send=self.sent.append, progress=lambda: None)

    async def ask(self, request: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        """Ask, and return what is done once that is answered."""
        task = asyncio.create_task(request)
        await asyncio.sleep(0)
        return task


async def done(*tasks: asyncio.Task[None]) -> tuple[bool, ...]:
    """Return which have been answered."""
    await asyncio.sleep(0)
    return tuple(task.done() for task in tasks)


@pytest.mark.virtual
async def test_an_answer_to_an_older_request_is_none_to_a_newer_one() -> None:
    """The world has gone on by the resume and told so while the second hold was on its way to it."""
    asked = Asked()
    resume = await asked.ask(asked.motion.resume())
    hold = await asked.ask(asked.motion.hold())
    asked.motion.take(MotionResumed(motion=7, request=1))
    assert await done(resume, hold) == (True, False)
    asked.motion.take(MotionHeld(motion=7, request=2))
    assert await done(resume, hold) == (True, True)


@pytest.mark.virtual
async def test_the_answer_to_the_latest_request_answers_those_before() -> None:
    """The world never tells of a hold that was overtaken by a resume."""
    asked = Asked()
    hold = await asked.ask(asked.motion.hold())
    resume = await asked.ask(asked.motion.resume())
    asked.motion.take(MotionResumed(motion=7, request=2))
    assert await done(hold, resume) == (True, True)


@pytest.mark.virtual
async def test_the_end_answers_all() -> None:
    asked = Asked()
    waiting = [await asked.ask(asked.motion.hold()), await asked.ask(asked.motion.resume())]
    waiting[0].cancel()
    asked.motion.take(MotionFinished(motion=7, progress=0.4, report=MotionReport(end=MotionEnd.CANCELED)))
    assert await done(*waiting) == (True, True)
    assert ((await asked.motion.report()).end, asked.motion.progress) == (MotionEnd.CANCELED, 0.4)
