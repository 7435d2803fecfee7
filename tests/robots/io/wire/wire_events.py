"""Events of connections, made by hand."""

from __future__ import annotations

from robots.io.wire.wire_tap import WireEndpoints, WireEvent, WireEventKind

TCP4 = WireEndpoints(local=("192.168.1.2", 40001), remote=("192.168.1.11", 502))
TCP6 = WireEndpoints(local=("fe80::2", 40001), remote=("fe80::11", 502))
UDP = WireEndpoints(local=("127.0.0.1", 30000), remote=("127.0.0.2", 10000))


def event(
    kind: WireEventKind, data: bytes = b"", *, endpoints: WireEndpoints | None = TCP4, time_ns: int = 1_000
) -> WireEvent:
    """Return an event."""
    return WireEvent(time_ns=time_ns, kind=kind, data=data, endpoints=endpoints)
