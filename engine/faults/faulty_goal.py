"""A faulty goal: the handle that a state receives instead of the goal that was sent, if any."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any

from engine.bus import GoalEnd
from engine.runtime.record.skill_port import Goal

AnyGoalEnd = GoalEnd[Any]
GoalScript = Callable[["FaultyGoal"], Coroutine[Any, Any, AnyGoalEnd]]


class FaultyGoal:
    """The `engine.runtime.record.skill_port.Goal` of a request that a fault is applied to.

    Args:
        play: Coroutine that defines how and when it ends.
        sent: The goals that the device received: none, one, or two.
        name: Name of the task of `play`.
        ignores_cancel: Whether cancel requests are not forwarded.
    """

    def __init__(self, play: GoalScript, *, sent: tuple[Goal, ...], name: str, ignores_cancel: bool = False) -> None:
        self.cancel_asked = asyncio.Event()
        self._sent = sent
        self._ignores_cancel = ignores_cancel
        self._task = asyncio.create_task(play(self), name=name)

    @property
    def finished(self) -> bool:
        """True once it has ended."""
        return self._task.done()

    async def result(self) -> AnyGoalEnd:
        """Wait for the end; cancelling this wait does not cancel the goal."""
        return await asyncio.shield(self._task)

    def cancel(self) -> None:
        """Request a cancel, unless the fault suppresses it."""
        self.cancel_asked.set()
        if not self._ignores_cancel:
            for goal in self._sent:
                goal.cancel()

    async def hold(self) -> None:
        """Hold the goal; a goal that the device never received needs no hold."""
        for goal in self._sent:
            await goal.hold()

    async def resume(self) -> None:
        """Resume the goal."""
        for goal in self._sent:
            await goal.resume()

    def deliver(self, goal: Goal) -> None:
        """Add a goal that was sent later: it is cancelled and held together with the others."""
        self._sent = (*self._sent, goal)
