"""HTTP of one client whose bytes are captured, but not what proves who asks."""

from __future__ import annotations

import socket
from collections.abc import Iterable
from typing import Any

import httpcore
import httpx

from robots.io.wire.header_secrets import HeaderSecrets
from robots.io.wire.tcp_connection import endpoints_of
from robots.io.wire.wire_tap import WireTap

_KEEP_S = 5.0


class CapturedTransport(httpx.HTTPTransport):
    """The transport of httpx on connections whose bytes are noted.

    Args:
        tap: Notes them; credentials and cookies are replaced before.
    """

    def __init__(self, tap: WireTap) -> None:
        super().__init__(trust_env=False)
        # httpx offers no place for a network of ours. Connections are kept as long as without a capture.
        self._pool.close()
        self._pool = httpcore.ConnectionPool(network_backend=_CapturedNetwork(tap), keepalive_expiry=_KEEP_S)


class _CapturedNetwork(httpcore.NetworkBackend):
    """Opens connections as httpcore does."""

    def __init__(self, tap: WireTap) -> None:
        self._tap = tap
        self._network = httpcore.SyncBackend()

    def connect_tcp(
        self,
        host: str,
        port: int,
        timeout: float | None = None,
        local_address: str | None = None,
        socket_options: Iterable[Any] | None = None,
    ) -> httpcore.NetworkStream:
        """Connect, and note it."""
        stream = self._network.connect_tcp(host, port, timeout, local_address, socket_options)
        return _CapturedStream(stream, self._tap)


class _CapturedStream(httpcore.NetworkStream):
    """One connection."""

    def __init__(self, stream: httpcore.NetworkStream, tap: WireTap) -> None:
        self._stream = stream
        self._tap = tap
        self._sent, self._received = HeaderSecrets(), HeaderSecrets()
        connected = stream.get_extra_info("socket")
        tap.opened(endpoints_of(connected) if isinstance(connected, socket.socket) else None)

    def read(self, max_bytes: int, timeout: float | None = None) -> bytes:
        """Return what arrives next; empty once the device has closed the connection."""
        data = self._stream.read(max_bytes, timeout)
        if data:
            self._note_received(self._received.passed(data))
        else:
            self._note_received(self._received.rest())
            self._tap.ended()
        return data

    def write(self, buffer: bytes, timeout: float | None = None) -> None:
        """Send all bytes."""
        self._stream.write(buffer, timeout)
        self._note_sent(self._sent.passed(buffer))

    def close(self) -> None:
        """Close it."""
        self._stream.close()
        self._note_sent(self._sent.rest())
        self._note_received(self._received.rest())
        self._tap.closed()

    def get_extra_info(self, info: str) -> Any:
        """Return what httpcore knows of the connection."""
        return self._stream.get_extra_info(info)

    def _note_sent(self, data: bytes) -> None:
        if data:
            self._tap.sent(data)

    def _note_received(self, data: bytes) -> None:
        if data:
            self._tap.received(data)
