"""A TCP server whose program serves one client; others are connected, wait, and follow when that one has gone."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Protocol

from robots.drivers.abb.emulation.controller_sessions import SessionClosed
from robots.drivers.emulation.byte_stream import answer
from robots.drivers.emulation.tcp_server import TcpServer
from robots.drivers.emulation.wire_faults import WireFaults, spoil

_READ_BYTES = 4096
_PERIOD_S = 0.1


class PortSession(Protocol):
    """The program of a port with one client."""

    def feed(self, received: bytes) -> bytes:
        """Take bytes and return the reply; raises SessionClosed."""
        ...


class SingleClientServer(TcpServer):
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
        super().__init__(host=host, port=port)
        self._new_session = new_session
        self._faults = faults
        self._messages = messages
        self._turn = asyncio.Lock()

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Run the program for a client, once those before it have gone."""
        async with self._turn:
            if self._messages is not None and not writer.is_closing():
                self._send(writer, self._messages)
            session = self._new_session()
            try:
                while received := await reader.read(_READ_BYTES):
                    answer(session, received, self._faults, writer.write)
            except SessionClosed:
                pass  # the program has ended the connection

    def _send(self, writer: asyncio.StreamWriter, messages: Callable[[], bytes]) -> None:
        """Send now, and again after each period until the connection is closed."""
        if writer.is_closing():
            return
        loop, faults = asyncio.get_running_loop(), self._faults
        if not faults.frozen and not faults.cut:
            packet = spoil(messages()) if faults.garbage else messages()
            loop.call_later(faults.slow_s, writer.write, packet)
        loop.call_later(_PERIOD_S, self._send, writer, messages)
