"""A serial line to one device through pyserial: a device file, or `socket://host:port` of a serial server."""

from __future__ import annotations

import select
import socket
import time
from contextlib import suppress
from typing import Any

import serial

from robots.io.wire.link_error import LinkError
from robots.io.wire.tcp_connection import endpoints_of
from robots.io.wire.wire_tap import NO_TAP, WireTap

_SLICE_S = 0.02
_READ_BYTES = 4096
_QUIET_TIMEOUTS = 2.0
_MOST_DRAINS = 50
_DRAINED_BYTES = 256
_SHOWN_BYTES = 12


class SerialStream:
    """Bytes in both directions; used by one thread.

    Args:
        device: Device file, or a URL that pyserial knows.
        baud: Its rate, 8N1.
        timeout_s: Time limit of a write, and of the wait for a quiet line.
        tap: Notes its bytes.
    """

    def __init__(self, device: str, *, baud: int, timeout_s: float, tap: WireTap = NO_TAP) -> None:
        self.device = device
        self._baud = baud
        self._timeout_s = timeout_s
        self._tap = tap
        self._line: Any = None
        self._socket: socket.socket | None = None

    @property
    def is_open(self) -> bool:
        """Whether it is open."""
        return self._line is not None

    def open(self) -> None:
        """Open the line."""
        try:
            self._line = serial.serial_for_url(
                self.device, baudrate=self._baud, timeout=_SLICE_S, write_timeout=self._timeout_s
            )
        except (OSError, ValueError) as error:
            raise LinkError(f"cannot connect: {_first_line(error)}") from error
        self._socket = connection = _socket_of(self._line)
        if connection is not None:
            # A command without an answer, and then a request: Nagle's algorithm would keep the second for 40 ms.
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._tap.opened(endpoints_of(connection) if connection is not None else None)

    def close(self) -> None:
        """Close the line."""
        line, self._line = self._line, None
        connection, self._socket = self._socket, None
        if line is not None:
            with suppress(OSError):  # it is closed because it failed, or because nobody needs it any more
                line.close()
            if connection is not None:
                # pyserial leaves one open that its peer has closed.
                connection.close()
            self._tap.closed()

    def write(self, sent: bytes) -> None:
        """Send bytes."""
        line = self._opened()
        try:
            line.write(sent)
            line.flush()
        except OSError as error:
            raise _lost(error) from error
        self._tap.sent(sent)

    def read(self, limit_s: float) -> bytes:
        """Return what arrives next; empty if nothing does until `limit_s` on the monotonic clock."""
        line = self._opened()
        try:
            received = self._arrived(line)
            while not received and time.monotonic() < limit_s:
                received = self._arrived(line)
        except (OSError, TypeError) as error:
            # pyserial leaves with a TypeError where its device has vanished in the middle of a read.
            raise _lost(error) from error
        if received:
            self._tap.received(received)
        return received

    def drain(self) -> None:
        """Wait until the line is quiet: answers without a number may belong to earlier requests."""
        for _ in range(_MOST_DRAINS):
            if not self.read(time.monotonic() + _QUIET_TIMEOUTS * self._timeout_s):
                return
        raise LinkError("the line is never quiet: is another client on it?")

    def _arrived(self, line: Any) -> bytes:
        """Return what has arrived, or arrives within a slice of time."""
        connection = self._socket
        if connection is None:
            return bytes(line.read(max(1, line.in_waiting)))
        # pyserial reads a socket byte by byte.
        if not select.select([connection], [], [], _SLICE_S)[0]:
            return b""
        received = connection.recv(_READ_BYTES)
        if not received:
            self._tap.ended()
            raise ConnectionResetError("socket disconnected")
        return received

    def _opened(self) -> Any:
        if self._line is None:
            raise LinkError("not connected")
        return self._line


def shown(received: bytes) -> str:
    """Return bytes for a message."""
    return received[:_SHOWN_BYTES].hex(" ")


def _socket_of(line: Any) -> socket.socket | None:
    """Return the socket below a line that is a `socket://`; pyserial has no public name for it."""
    connection: object = getattr(line, "_socket", None)
    return connection if isinstance(connection, socket.socket) else None


def _lost(error: Exception) -> LinkError:
    return LinkError(f"the serial line failed: {_first_line(error)}")


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
