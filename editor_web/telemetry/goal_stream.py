"""The progress of one goal as lines of JSON; the goal is cancelled if its client disconnects."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from dataclasses import replace
from typing import Any

import msgspec
from fastapi.responses import StreamingResponse
from starlette.types import Receive, Scope, Send

from editor_web.telemetry.bus_bodies import GoalEndLine, GoalProgressLine, GoalSentLine, GoalStreamLine
from editor_web.telemetry.truncate import truncate_value
from engine.bus import GoalHandle
from engine.project import BusInspector

PERIOD_S = 0.2


class GoalStream(StreamingResponse):
    """Streams the progress of a goal; ends only when the goal has ended and its device is at rest."""

    def __init__(self, inspector: BusInspector, handle: GoalHandle[Any, Any]) -> None:
        super().__init__(_nothing(), media_type="application/x-ndjson")
        self._inspector = inspector
        self._handle = handle

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send until the goal ends or the client disconnects."""
        ending = asyncio.create_task(self._inspector.ended(self._handle), name=f"goal {self._handle.id}")
        gone = asyncio.create_task(wait_for_disconnect(receive), name="goal-client")
        try:
            await send({"type": "http.response.start", "status": 200, "headers": self.raw_headers})
            await self._send_line(send, GoalSentLine(goal=self._handle.id))
            before: tuple[str, object] = ("", None)
            while not ending.done() and not gone.done():
                now = (self._handle.status.value, self._handle.feedback)
                if now != before:
                    await self._send_line(send, GoalProgressLine(status=now[0], feedback=truncate_value(now[1])))
                    before = now
                await asyncio.wait({ending, gone}, timeout=PERIOD_S, return_when=asyncio.FIRST_COMPLETED)
            if ending.done() and not gone.done():
                end = ending.result()
                last = GoalEndLine(end=replace(end, result=truncate_value(end.result)))
                await self._send_line(send, last)
                await send({"type": "http.response.body", "body": b"", "more_body": False})
        finally:
            gone.cancel()
            # Not through the task that waits for it, which may not have started.
            self._handle.cancel()
            # The goal ends only when its device is at rest.
            await asyncio.wait({ending, gone})

    async def _send_line(self, send: Send, line: GoalStreamLine) -> None:
        await send({"type": "http.response.body", "body": msgspec.json.encode(line) + b"\n", "more_body": True})


async def _nothing() -> AsyncGenerator[bytes]:
    return
    yield b""


async def wait_for_disconnect(receive: Receive) -> None:
    """Wait until the client of a request disconnects."""
    while (await receive())["type"] != "http.disconnect":
        pass
