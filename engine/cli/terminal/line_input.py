"""Reads lines of a terminal, pipe or file as they arrive, on the event loop and without a thread."""

from __future__ import annotations

import asyncio
import os
from collections import deque
from collections.abc import Callable

from engine.clock import VirtualLoop

_READ_BYTES = 65_536


class LineInput:
    """Delivers one line after another, and the end of input, until it is closed.

    Args:
        descriptor: The open file; None is a file at its end.
        line: Called with each line, without its line end.
        end: Called once, after the last line.
    """

    def __init__(self, descriptor: int | None, *, line: Callable[[str], None], end: Callable[[], None]) -> None:
        self._descriptor = descriptor
        self._line = line
        self._end = end
        self._loop = asyncio.get_running_loop()
        self._rest = b""
        self._lines: deque[str] = deque()
        self._ended = False
        self._end_reported = False
        self._held = False
        self._reading = False
        self._closed = False

    def open(self) -> None:
        """Start reading."""
        self._loop.call_soon(self._deliver)

    def hold(self) -> None:
        """Deliver nothing until `release`; lines that arrive are queued."""
        self._held = True
        self._stop_reading()

    def release(self) -> None:
        """Resume delivery, beginning with the queued lines."""
        self._held = False
        self._loop.call_soon(self._deliver)

    def close(self) -> None:
        """Stop delivery for good."""
        self._closed = True
        self._stop_reading()

    def _deliver(self) -> None:
        while self._lines and not self._held and not self._closed:
            self._line(self._lines.popleft())
        if self._held or self._closed or self._end_reported:
            return
        if self._ended or self._descriptor is None:
            self._end_reported = True
            self._stop_reading()
            self._end()
        else:
            self._start_reading(self._descriptor)

    def _start_reading(self, descriptor: int) -> None:
        if self._reading:
            return
        try:
            self._loop.add_reader(descriptor, self._ready, descriptor)
        except PermissionError:
            # A regular file or /dev/null cannot be polled: it is always ready.
            self._loop.call_soon(self._ready, descriptor)
            return
        self._reading = True
        self._announce_input(1)

    def _stop_reading(self) -> None:
        if self._reading and self._descriptor is not None:
            self._loop.remove_reader(self._descriptor)
            self._reading = False
            self._announce_input(-1)

    def _announce_input(self, change: int) -> None:
        if isinstance(self._loop, VirtualLoop):
            # When nothing else happens, virtual time must wait for keyboard input.
            self._loop.expect_outside(change)

    def _ready(self, descriptor: int) -> None:
        if self._closed:
            return
        try:
            read = os.read(descriptor, _READ_BYTES)
        except OSError:
            read = b""  # the terminal was closed
        self._ended = not read
        *lines, self._rest = (self._rest + read).split(b"\n")
        if self._ended and self._rest:
            lines.append(self._rest)
        self._lines.extend(line.decode("utf-8", "replace").rstrip("\r") for line in lines)
        self._deliver()
