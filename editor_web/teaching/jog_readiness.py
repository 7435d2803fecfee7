"""Prepares the arm that a page will jog, so that the first press moves it; tells the page until then that it waits."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from editor_web.teaching.teaching_messages import JogReadiness
from engine.bus import JsonBus
from engine.errors import FlexcellError, NoSuchSkill


class JogPreparation:
    """Prepares one arm at a time.

    Args:
        bus: The bus of the arms.
        send: Receives the readiness for the page.
    """

    def __init__(self, bus: JsonBus, send: Callable[[JogReadiness], None]) -> None:
        self._bus = bus
        self._send = send
        self._task: asyncio.Task[None] | None = None
        self.arm = ""

    def begin(self, arm: str) -> None:
        """Prepare an arm from now on; none where the name is empty."""
        self.arm = arm
        self.repeat()

    def repeat(self) -> None:
        """Prepare the arm anew, as after a stop."""
        if self._task is not None:
            self._task.cancel()
        if not self.arm:
            return
        self._send(JogReadiness(arm=self.arm, ready=False))
        self._task = asyncio.create_task(self._prepare(self.arm), name=f"prepare jogging of {self.arm}")

    async def close(self) -> None:
        """Prepare nothing more."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})

    async def _prepare(self, arm: str) -> None:
        reason = ""
        try:
            await self._bus.call(f"{arm}/prepare_jog", {})
        except NoSuchSkill:
            # A driver without collision checks has nothing to prepare.
            pass
        except FlexcellError as error:
            reason = error.message
        self._send(JogReadiness(arm=arm, ready=not reason, reason=reason))
