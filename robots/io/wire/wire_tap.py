"""What is noted of one connection: when it was opened and closed, and every byte in either direction."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Address = tuple[str, int]
"""IP address and port."""

WireEventKind = Literal["opened", "sent", "received", "ended", "closed"]
"""`ended`: the device has closed its side; `closed`: we have."""


@dataclass(frozen=True, kw_only=True)
class WireEndpoints:
    """Both ends of a connection or datagram in an IP network."""

    local: Address
    remote: Address


@dataclass(frozen=True, kw_only=True)
class WireEvent:
    """One event of a connection; `time_ns` is of the monotonic clock, `endpoints` None for a serial line."""

    time_ns: int
    kind: WireEventKind
    data: bytes = b""
    endpoints: WireEndpoints | None = None


class WireTap:
    """Passes the events of one connection on; without a sink, which is the normal case, it does nothing.

    Args:
        sink: Receives every event, and must not block.
    """

    def __init__(self, sink: Callable[[WireEvent], None] | None = None) -> None:
        self._sink = sink
        self._endpoints: WireEndpoints | None = None

    @property
    def is_active(self) -> bool:
        """Whether anybody receives the events."""
        return self._sink is not None

    def opened(self, endpoints: WireEndpoints | None = None) -> None:
        """Note that the connection is open; a serial line has no endpoints."""
        self._endpoints = endpoints
        self._note("opened")

    def sent(self, data: bytes, endpoints: WireEndpoints | None = None) -> None:
        """Note sent bytes; those of a datagram have endpoints of their own."""
        self._note("sent", data, endpoints)

    def received(self, data: bytes, endpoints: WireEndpoints | None = None) -> None:
        """Note received bytes; those of a datagram have endpoints of their own."""
        self._note("received", data, endpoints)

    def ended(self) -> None:
        """Note that the device has closed its side."""
        self._note("ended")

    def closed(self) -> None:
        """Note that the connection was closed."""
        self._note("closed")

    def _note(self, kind: WireEventKind, data: bytes = b"", endpoints: WireEndpoints | None = None) -> None:
        if self._sink is not None:
            ends = endpoints or self._endpoints
            self._sink(WireEvent(time_ns=time.monotonic_ns(), kind=kind, data=data, endpoints=ends))


NO_TAP = WireTap()
