"""Serves a protocol on a TCP address or a pty, with the faults of the wire."""

from __future__ import annotations

import asyncio
import os
import tty
from collections.abc import Callable
from typing import Protocol

from robots.drivers.emulation.wire_faults import WireFaults, spoil

_READ_BYTES = 4096


class ProtocolSession(Protocol):
    """The protocol of one connection."""

    def feed(self, received: bytes) -> bytes:
        """Take bytes, which may be parts of requests, and return the replies to those that are complete."""
        ...


SessionMaker = Callable[[], ProtocolSession]


class TcpStream:
    """A TCP server that can be cut and restored at the same address."""

    def __init__(self, new_session: SessionMaker, faults: WireFaults, *, host: str, port: int) -> None:
        self._new_session = new_session
        self._faults = faults
        self._host = host
        self._port = port
        self._server: asyncio.Server | None = None
        self._writers: set[asyncio.StreamWriter] = set()

    @property
    def clients(self) -> int:
        """Number of open connections."""
        return len(self._writers)

    async def open(self) -> dict[str, object]:
        """Listen; returns where."""
        self._server = await asyncio.start_server(self._serve, self._host, self._port, reuse_address=True)
        self._port = self._server.sockets[0].getsockname()[1]
        return {"host": self._host, "port": self._port}

    async def close(self) -> None:
        """Stop listening and drop all connections."""
        if self._server is not None:
            self._server.close()
            self._server = None
        for writer in tuple(self._writers):
            writer.transport.abort()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        session = self._new_session()
        self._writers.add(writer)
        try:
            while received := await reader.read(_READ_BYTES):
                answer(session, received, self._faults, writer.write)
        except ConnectionError:
            pass  # the client, or a fault that we emulate, has dropped the connection
        finally:
            self._writers.discard(writer)
            writer.close()


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

    def _receive(self, ours: int) -> None:
        answer(self._session, os.read(ours, _READ_BYTES), self._faults, lambda reply: os.write(ours, reply))


def answer(session: ProtocolSession, received: bytes, faults: WireFaults, write: Callable[[bytes], object]) -> None:
    """Answer received bytes, as the faults of the wire allow."""
    if faults.cut or faults.frozen:
        return
    reply = session.feed(received)
    if not reply:
        return
    reply = spoil(reply) if faults.garbage else reply
    if faults.slow_s > 0.0:
        asyncio.get_running_loop().call_later(faults.slow_s, write, reply)
    else:
        write(reply)
