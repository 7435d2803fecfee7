"""A faulty goal: the handle that a state gets in place of the goal that was sent, if one was."""

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
        play: Decides how and when it ends.
        sent: What the device got: nothing, the goal, or the goal twice.
        name: Of the task that plays.
        ignores_cancel: Do not pass a cancel on.
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
        """Ask for the stop, as far as the fault lets the question through."""
        self.cancel_asked.set()
        if not self._ignores_cancel:
            for goal in self._sent:
                goal.cancel()

    async def hold(self) -> None:
        """Bring the device to rest; what the device never got needs none."""
        for goal in self._sent:
            await goal.hold()

    async def resume(self) -> None:
        """Let it go on."""
        for goal in self._sent:
            await goal.resume()

    def deliver(self, goal: Goal) -> None:
        """Take a goal that was sent meanwhile: it is cancelled and held along."""
        self._sent = (*self._sent, goal)
