"""A TCP connection of a driver, without delays for small packets; its bytes can be captured."""

from __future__ import annotations

import asyncio
import socket
from contextlib import suppress
from typing import Any, Self

from robots.io.wire.wire_tap import NO_TAP, Address, WireEndpoints, WireTap

# Of a connection that was lost before it could be asked.
_UNKNOWN = ("0.0.0.0", 0)  # noqa: S104 - nothing is bound


class TcpConnection:
    """Connected while it lives; used by one thread. What fails raises OSError.

    Args:
        where: Host and port.
        timeout_s: Time limit of connecting, and of each call until `set_timeout`.
        tap: Notes its bytes.
    """

    _socket: socket.socket
    _tap: WireTap

    def __init__(self, where: Address, *, timeout_s: float, tap: WireTap = NO_TAP) -> None:
        self._begin(socket.create_connection(where, timeout=timeout_s), tap)

    @classmethod
    def of(cls, connected: socket.socket, tap: WireTap) -> Self:
        """Return the connection of a socket that is connected."""
        connection = cls.__new__(cls)
        connection._begin(connected, tap)
        return connection

    def _begin(self, connected: socket.socket, tap: WireTap) -> None:
        self._socket, self._tap = connected, tap
        # Small packets without answers would be kept for 40 ms by Nagle's algorithm.
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if tap.is_active:
            tap.opened(endpoints_of(self._socket))

    def fileno(self) -> int:
        """Return the file descriptor, for `select`."""
        return self._socket.fileno()

    def set_timeout(self, timeout_s: float) -> None:
        """Set the time limit of each call; 0 for calls that never wait."""
        self._socket.settimeout(timeout_s)

    def send(self, data: bytes) -> None:
        """Send all bytes."""
        self._socket.sendall(data)
        self._tap.sent(data)

    def send_some(self, data: bytes | bytearray) -> int:
        """Send what the connection takes at once, and return how many bytes; from then on calls never wait."""
        self._socket.settimeout(0.0)
        try:
            sent = self._socket.send(data)
        except BlockingIOError:
            return 0
        self._tap.sent(bytes(data[:sent]))
        return sent

    def has_bytes(self) -> bool:
        """Return whether something waits, also the end of the connection; from then on calls never wait."""
        self._socket.settimeout(0.0)
        try:
            self._socket.recv(1, socket.MSG_PEEK)
        except BlockingIOError:
            return False
        return True

    def receive(self, most: int) -> bytes:
        """Return what arrives next; empty once the device has closed the connection."""
        try:
            return self._noted(self._socket.recv(most))
        except ConnectionResetError:
            self._tap.ended()
            raise

    async def receive_next(self, most: int) -> bytes:
        """Return what arrives next, on the event loop; the time limit must be 0."""
        return self._noted(await asyncio.get_running_loop().sock_recv(self._socket, most))

    def shut_down(self) -> None:
        """End both directions, so that nobody waits for bytes any more."""
        with suppress(OSError):  # it has failed already
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Close it."""
        with suppress(OSError):  # it is closed because it failed, or because nobody needs it any more
            self._socket.close()
        self._tap.closed()

    def _noted(self, received: bytes) -> bytes:
        if received:
            self._tap.received(received)
        else:
            self._tap.ended()
        return received


def endpoints_of(connection: socket.socket) -> WireEndpoints:
    """Return both ends of a connection; unknown ones where it is lost already."""
    try:
        return WireEndpoints(local=address_of(connection.getsockname()), remote=address_of(connection.getpeername()))
    except OSError:
        return WireEndpoints(local=_UNKNOWN, remote=_UNKNOWN)


def address_of(name: Any) -> Address:
    """Return the IP address and port in the name of a socket; that of IPv6 has two numbers more."""
    host, port = name[:2]
    return str(host), int(port)
