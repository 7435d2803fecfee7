"""The script port of a controller: programs are sent without waiting for it."""

from __future__ import annotations

import time

from robots.io.wire.pending_connection import PendingConnection
from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_tap import NO_TAP, WireTap

_READ_BYTES = 65_536


class ScriptPort:
    """One connection, opened with the first program; used by one thread, and no call waits.

    Args:
        host: Address of the controller.
        port: Its primary or secondary port; both execute what they receive.
        limit_s: How long a program may wait for the connection.
        tap: Notes its bytes.
    """

    def __init__(self, host: str, port: int, *, limit_s: float, tap: WireTap = NO_TAP) -> None:
        self._address = (host, port)
        self._tap = tap
        self._limit_s = limit_s
        self._pending: PendingConnection | None = None
        self._connection: TcpConnection | None = None
        self._unsent = bytearray()
        self._end_s = 0.0
        self.problem = ""
        """Why the programs sent last did not get there; empty if they did, or still may."""

    def send(self, program: str) -> None:
        """Send a program as soon as there is a connection."""
        self.problem = ""
        self._unsent += program.encode()
        self._end_s = time.monotonic() + self._limit_s
        if self._pending is None and self._connection is None:
            self._begin()
        self.advance()

    def advance(self) -> None:
        """Go on with what was sent; has to be called again and again."""
        try:
            if self._pending is not None:
                self._connection = self._pending.connected()
                if self._connection is not None:
                    self._pending = None
                elif time.monotonic() > self._end_s:
                    self._end(f"no connection within {self._limit_s:g} s")
            connection = self._connection
            if connection is None:
                return
            if self._unsent:
                del self._unsent[: connection.send_some(self._unsent)]
            # The controller reports its state here several times a second.
            if connection.has_bytes() and not connection.receive(_READ_BYTES):
                self._end("the controller closed it")
        except OSError as error:
            self._end(error.strerror or str(error))
            return
        if self._unsent and time.monotonic() > self._end_s:
            self._end(f"it takes nothing within {self._limit_s:g} s")

    def close(self) -> None:
        """Disconnect; what was not sent is dropped."""
        opened = (self._pending, self._connection)
        self._pending = self._connection = None
        self._unsent.clear()
        for each in opened:
            if each is not None:
                each.close()

    def _begin(self) -> None:
        try:
            self._pending = PendingConnection(self._address, tap=self._tap)
        except OSError as error:
            self._end(error.strerror or str(error))

    def _end(self, reason: str) -> None:
        """Disconnect; a connection that has nothing to send may end without being a problem."""
        if self._unsent:
            self.problem = f"script port {self._address[1]}: {reason}"
        self.close()
