"""Executes the motions of one tool, one at a time, for the servers of all kinds of tools."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from engine.bus import ActiveGoal
from engine.errors import RobotError, SkillFailed
from robots.port import Motion
from robots.supervise_goal import supervise_goal


class ToolMotion:
    """The active motion; `device` is the bus name of the tool, `words` its human-readable name."""

    def __init__(self, *, device: str, words: str) -> None:
        self._device = device
        self._words = words
        self._motion: Motion | None = None

    @property
    def moving(self) -> bool:
        """True while a goal is executing."""
        return self._motion is not None

    async def stop(self) -> None:
        """Cancel the active motion and return at its end."""
        if self._motion is not None:
            self._motion.cancel()
            await self._motion.report()

    async def carry_out(
        self, start: Callable[[], Motion], handle: ActiveGoal[Any], publish: Callable[[], None]
    ) -> None:
        """Start a motion and return when it has ended at rest, also when cancelled.

        Raises:
            SkillFailed: it could not be started, failed, or was stopped by another client.
        """
        try:
            motion = start()
        except RobotError as error:
            raise SkillFailed(f"{self._words} did not start", where=handle.address) from error
        self._motion = motion
        try:
            await supervise_goal(motion, handle, publish=publish, device=self._device, words=self._words)
        finally:
            self._motion = None
