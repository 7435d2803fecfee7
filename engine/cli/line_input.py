"""Reads the lines of a terminal, pipe or file as they come, on the event loop and without a thread."""

from __future__ import annotations

import asyncio
import os
from collections import deque
from collections.abc import Callable

from engine.clock import VirtualLoop

_READ_BYTES = 65_536


class LineInput:
    """Hands over one line after another, and the end of input, until it is closed.

    Args:
        descriptor: The open file; None is one that has ended.
        line: Takes a line without its end.
        end: Told once, after the last line.
    """

    def __init__(self, descriptor: int | None, *, line: Callable[[str], None], end: Callable[[], None]) -> None:
        self._descriptor = descriptor
        self._line = line
        self._end = end
        self._loop = asyncio.get_running_loop()
        self._rest = b""
        self._lines: deque[str] = deque()
        self._ended = False
        self._told = False
        self._held = False
        self._reading = False
        self._closed = False

    def open(self) -> None:
        """Begin."""
        self._loop.call_soon(self._go_on)

    def hold(self) -> None:
        """Hand over nothing until `release`; what comes meanwhile waits."""
        self._held = True
        self._stop_reading()

    def release(self) -> None:
        """Go on with what has come."""
        self._held = False
        self._loop.call_soon(self._go_on)

    def close(self) -> None:
        """Hand over nothing more."""
        self._closed = True
        self._stop_reading()

    def _go_on(self) -> None:
        while self._lines and not self._held and not self._closed:
            self._line(self._lines.popleft())
        if self._held or self._closed or self._told:
            return
        if self._ended or self._descriptor is None:
            self._told = True
            self._stop_reading()
            self._end()
        else:
            self._read_on(self._descriptor)

    def _read_on(self, descriptor: int) -> None:
        if self._reading:
            return
        try:
            self._loop.add_reader(descriptor, self._ready, descriptor)
        except PermissionError:
            # A regular file or /dev/null cannot be waited for: it is always ready.
            self._loop.call_soon(self._ready, descriptor)
            return
        self._reading = True
        self._expect(1)

    def _stop_reading(self) -> None:
        if self._reading and self._descriptor is not None:
            self._loop.remove_reader(self._descriptor)
            self._reading = False
            self._expect(-1)

    def _expect(self, change: int) -> None:
        if isinstance(self._loop, VirtualLoop):
            # Virtual time has to wait for who types when nothing else happens.
            self._loop.expect_outside(change)

    def _ready(self, descriptor: int) -> None:
        if self._closed:
            return
        try:
            read = os.read(descriptor, _READ_BYTES)
        except OSError:
            read = b""  # the terminal has gone
        self._ended = not read
        *lines, self._rest = (self._rest + read).split(b"\n")
        if self._ended and self._rest:
            lines.append(self._rest)
        self._lines.extend(line.decode("utf-8", "replace").rstrip("\r") for line in lines)
        self._go_on()
