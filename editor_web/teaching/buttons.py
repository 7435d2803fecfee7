"""Buttons of a page on the bus: published on press and release, and released when the page disconnects."""

from __future__ import annotations

from collections.abc import Callable

from editor_web.teaching.teaching_messages import ButtonInput, RefusedFrame
from engine.bus import JsonBus
from engine.errors import BusError

MOST_BUTTONS = 64


class PressedButtons:
    """The pressed buttons of one page."""

    def __init__(self, bus: JsonBus, *, send: Callable[[RefusedFrame], None]) -> None:
        self._bus = bus
        self._send = send
        self._down: set[str] = set()

    async def take(self, button: ButtonInput) -> None:
        """Publish a button on the bus; a topic without a trigger is refused with a message."""
        topic = f"buttons/{button.source}/{button.button}"
        if button.value and len(self._down) >= MOST_BUTTONS:
            return
        try:
            await self._bus.publish(topic, {"value": button.value})
        except BusError as error:
            if button.value:
                self._send(RefusedFrame(what="button", message=f"no trigger listens to {topic}", hint=error.hint or ""))
            return
        (self._down.add if button.value else self._down.discard)(topic)

    async def release(self) -> None:
        """Release every button."""
        for topic in tuple(self._down):
            self._down.discard(topic)
            try:
                await self._bus.publish(topic, {"value": False})
            except BusError:
                # The trigger was removed meanwhile.
                continue
