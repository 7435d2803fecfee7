"""A TCP server whose program serves one client; others are connected, wait, and follow when that one has gone."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Protocol

from robots.drivers.abb.emulation.controller_sessions import SessionClosed
from robots.drivers.emulation.byte_stream import answer
from robots.drivers.emulation.wire_faults import WireFaults, spoil

_READ_BYTES = 4096
_PERIOD_S = 0.1


class PortSession(Protocol):
    """The program of a port with one client."""

    def feed(self, received: bytes) -> bytes:
        """Take bytes and return the reply; raises SessionClosed."""
        ...


class SingleClientServer:
    """One port of the controller.

    Args:
        new_session: Starts the program for a client.
        faults: Faults of the wire.
        host: Where to listen.
        port: 0 for a free one.
        messages: What the program sends by itself ten times a second, for the session of a client; None for nothing.
    """

    def __init__(
        self,
        new_session: Callable[[], PortSession],
        faults: WireFaults,
        *,
        host: str,
        port: int,
        messages: Callable[[], bytes] | None = None,
    ) -> None:
        self._new_session = new_session
        self._faults = faults
        self._host = host
        self.port = port
        self._messages = messages
        self._server: asyncio.Server | None = None
        self._turn = asyncio.Lock()
        self._writers: set[asyncio.StreamWriter] = set()

    @property
    def clients(self) -> int:
        """Number of connections, with those that wait."""
        return len(self._writers)

    async def open(self) -> None:
        """Listen, if it does not."""
        if self._server is not None:
            return
        self._server = await asyncio.start_server(self._serve, self._host, self.port, reuse_address=True)
        self.port = int(self._server.sockets[0].getsockname()[1])

    async def close(self) -> None:
        """Stop listening and drop all connections."""
        if self._server is not None:
            self._server.close()
            self._server = None
        for writer in tuple(self._writers):
            writer.transport.abort()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._writers.add(writer)
        try:
            async with self._turn:
                if self._messages is not None and not writer.is_closing():
                    self._send(writer, self._messages)
                session = self._new_session()
                while received := await reader.read(_READ_BYTES):
                    answer(session, received, self._faults, writer.write)
        except (ConnectionError, SessionClosed):
            pass  # the client, a fault that we emulate, or the program has ended the connection
        finally:
            self._writers.discard(writer)
            writer.close()

    def _send(self, writer: asyncio.StreamWriter, messages: Callable[[], bytes]) -> None:
        """Send now, and again after each period until the connection is closed."""
        if writer.is_closing():
            return
        loop, faults = asyncio.get_running_loop(), self._faults
        if not faults.frozen and not faults.cut:
            packet = spoil(messages()) if faults.garbage else messages()
            loop.call_later(faults.slow_s, writer.write, packet)
        loop.call_later(_PERIOD_S, self._send, writer, messages)
