"""Reads the button events of an input device until it is removed."""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncGenerator
from pathlib import Path

from engine.errors import RobotError
from engine.teaching.input_events import ButtonEvent, EventReader

_READ_BYTES = 4096


async def button_events(device: Path) -> AsyncGenerator[ButtonEvent]:
    """Yield the button events of `device`; buttons that are pressed when it is removed are released at the end.

    `device` is an event file such as `/dev/input/by-id/…-event-kbd`. The loop is never blocked.

    Raises:
        RobotError: the device cannot be opened or read; the hint says what to check.
    """
    loop = asyncio.get_running_loop()
    try:
        descriptor = os.open(device, os.O_RDONLY | os.O_NONBLOCK)
    except OSError as error:
        raise RobotError(
            f"the input device cannot be opened: {error.strerror}",
            where=str(device),
            hint="see /dev/input/by-id; reading it requires membership in the group `input`",
        ) from error
    readable = asyncio.Event()
    reader = EventReader()
    try:
        loop.add_reader(descriptor, readable.set)
        while True:
            await readable.wait()
            readable.clear()
            try:
                data = os.read(descriptor, _READ_BYTES)
            except BlockingIOError:
                continue
            except OSError:
                # Switched off or out of reach.
                data = b""
            for event in reader.feed(data):
                yield event
            if not data:
                break
    finally:
        loop.remove_reader(descriptor)
        os.close(descriptor)
    for event in reader.release():
        yield event
