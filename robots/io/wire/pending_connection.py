"""A TCP connection that is being opened, without waiting for the device."""

from __future__ import annotations

import errno
import os
import select
import socket

from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_tap import NO_TAP, Address, WireTap


class PendingConnection:
    """Begins to connect; used by one thread, and no call waits. What fails raises OSError.

    Args:
        where: Host and port.
        tap: Notes the bytes of the connection.
    """

    def __init__(self, where: Address, *, tap: WireTap = NO_TAP) -> None:
        self._tap = tap
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self._socket.setblocking(False)
        try:
            code = self._socket.connect_ex(where)
            if code not in (0, errno.EINPROGRESS):
                raise OSError(code, os.strerror(code))
        except OSError:  # also a name that nobody knows
            self._socket.close()
            raise

    def connected(self) -> TcpConnection | None:
        """Return the connection, whose calls never wait, once it exists."""
        _, writable, _ = select.select([], [self._socket], [], 0.0)
        if not writable:
            return None
        code = self._socket.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
        if code:
            raise OSError(code, os.strerror(code))
        return TcpConnection.of(self._socket, self._tap)

    def close(self) -> None:
        """Give it up."""
        self._socket.close()
