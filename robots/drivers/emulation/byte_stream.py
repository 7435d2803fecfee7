"""Serves a protocol on a TCP address or a pty, with the faults of the wire."""

from __future__ import annotations

import asyncio
import math
import os
import tty
from collections.abc import Callable
from typing import Protocol

from robots.drivers.emulation.tcp_server import TcpServer
from robots.drivers.emulation.wire_faults import WireFaults, spoil

_READ_BYTES = 4096


class ProtocolSession(Protocol):
    """The protocol of one connection."""

    def feed(self, received: bytes) -> bytes:
        """Take bytes, which may be parts of requests, and return the replies to those that are complete."""
        ...


SessionMaker = Callable[[], ProtocolSession]


class TcpStream(TcpServer):
    """A protocol on a TCP address."""

    def __init__(self, new_session: SessionMaker, faults: WireFaults, *, host: str, port: int) -> None:
        super().__init__(host=host, port=port)
        self._new_session = new_session
        self._faults = faults
        self._connected: Callable[[], None] = lambda: None

    async def unplug(self) -> None:
        """Take the device away: nothing listens any more."""
        await self.close()

    def when_connected(self, callback: Callable[[], None]) -> None:
        """Call `callback` for each new connection."""
        self._connected = callback

    def send(self, message: bytes) -> None:
        """Send what nobody asked for to all clients, as the faults of the wire allow."""
        for writer in tuple(self._writers):
            deliver(message, self._faults, writer.write)

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer what a client sends."""
        session = self._new_session()
        self._connected()
        while received := await reader.read(_READ_BYTES):
            answer(session, received, self._faults, writer.write)


class PtyStream:
    """A pseudo terminal as a serial line; `device` is the end for the client. A cut line loses all bytes."""

    def __init__(self, new_session: SessionMaker, faults: WireFaults) -> None:
        self._session = new_session()
        self._faults = faults
        self._ends: tuple[int, int] | None = None

    @property
    def clients(self) -> int:
        """Unknown: a serial line has no connections."""
        return 0

    async def open(self) -> dict[str, object]:
        """Create the line; returns where."""
        if self._ends is None:
            ours, theirs = os.openpty()
            for end in (ours, theirs):
                tty.setraw(end)
            # The client's end stays open here: otherwise reading fails while no client has opened it.
            self._ends = ours, theirs
            asyncio.get_running_loop().add_reader(ours, self._receive, ours)
        return {"device": os.ttyname(self._ends[1])}

    async def close(self) -> None:
        """Keep the line: a cut cable has both its ends."""

    async def unplug(self) -> None:
        """Take the device away: its name is gone, and a client that has it open fails. `open` makes another."""
        ends, self._ends = self._ends, None
        if ends is not None:
            asyncio.get_running_loop().remove_reader(ends[0])
            for end in ends:
                os.close(end)

    def send(self, message: bytes) -> None:
        """Send what nobody asked for, as the faults of the wire allow."""
        if self._ends is not None:
            deliver(message, self._faults, self._write)

    def _write(self, reply: bytes) -> None:
        if self._ends is not None:
            os.write(self._ends[0], reply)

    def _receive(self, ours: int) -> None:
        answer(self._session, os.read(ours, _READ_BYTES), self._faults, self._write)


def answer(session: ProtocolSession, received: bytes, faults: WireFaults, write: Callable[[bytes], object]) -> None:
    """Answer received bytes, as the faults of the wire allow."""
    if not faults.cut and not faults.frozen:
        deliver(session.feed(received), faults, write)


def deliver(message: bytes, faults: WireFaults, write: Callable[[bytes], object]) -> None:
    """Send bytes, as the faults of the wire allow."""
    if not message or faults.cut or faults.frozen:
        return
    message = spoil(message) if faults.garbage else message
    loop = asyncio.get_running_loop()
    now_s = loop.time()
    # Timers of one instant would have no order.
    due_s = max(now_s + faults.slow_s, math.nextafter(faults.late_until_s.get(write, 0.0), math.inf))
    if due_s <= now_s:
        faults.late_until_s.pop(write, None)
        write(message)
        return
    faults.late_until_s[write] = due_s
    loop.call_at(due_s, write, message)
