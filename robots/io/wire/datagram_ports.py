"""UDP sockets of several ports, read in the order in which the datagrams arrived."""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from engine.errors import FlexcellError
from robots.io.wire.wire_tap import NO_TAP, Address, WireEndpoints, WireTap

# Linux; Python's socket has no name for it. The kernel then says when each datagram arrived.
_TIMESTAMP = 35
_TIME = struct.Struct("qq")
_LONGEST = 2048
_AT_MOST = 512
_PROBE_LIMIT_S = 0.2


@dataclass(frozen=True)
class _Arrival:
    time_ns: int
    order: int
    port: int
    data: bytes
    sender: Address


class DatagramPorts:
    """Bound UDP sockets, one for each port.

    A motion is two packets at two ports, and their order matters. Several sockets that are ready at once have no
    order, so that all of them are read, and the datagrams sorted by the time that the kernel gave them.

    Args:
        address: IPv4 address.
        ports: The ports.
        tap: Notes the datagrams, in the order of their arrival.

    Raises:
        FlexcellError: a port is taken.
    """

    def __init__(self, address: str, ports: Sequence[int], *, tap: WireTap = NO_TAP) -> None:
        self._address = address
        self._tap = tap
        self._sockets: dict[int, socket.socket] = {}
        try:
            for port in ports:
                self._sockets[port] = _bound(address, port)
            _await_arrival_times(address)
        except BaseException:
            self.close()
            raise

    def filenos(self) -> tuple[int, ...]:
        """Return the file descriptors to wait for."""
        return tuple(each.fileno() for each in self._sockets.values())

    def read(self, take: Callable[[int, bytes, Address], None]) -> None:
        """Pass on what has arrived; at most a few hundred datagrams, so that others get their turn too."""
        arrivals: list[_Arrival] = []
        while len(arrivals) < _AT_MOST:
            # Until a round finds nothing: what arrives behind the reader may be older than what it reads next.
            before = len(arrivals)
            for port, each in self._sockets.items():
                arrival = _receive(each, port, len(arrivals))
                if arrival is not None:
                    arrivals.append(arrival)
            if len(arrivals) == before:
                break
        for arrival in sorted(arrivals, key=lambda each: (each.time_ns, each.order)):
            if self._tap.is_active:
                ends = WireEndpoints(local=(self._address, arrival.port), remote=arrival.sender)
                self._tap.received(arrival.data, ends)
            take(arrival.port, arrival.data, arrival.sender)

    def close(self) -> None:
        """Close all sockets."""
        for each in self._sockets.values():
            each.close()


def _bound(address: str, port: int) -> socket.socket:
    bound = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        bound.setblocking(False)
        bound.setsockopt(socket.SOL_SOCKET, _TIMESTAMP, 1)
        bound.bind((address, port))
    except OSError as error:
        bound.close()
        raise FlexcellError(
            f"cannot listen on {address}:{port}: {error.strerror or error}",
            where="--address",
            hint="another interface may be served there: choose another address of 127/8",
        ) from error
    return bound


def _await_arrival_times(address: str) -> None:
    """Return once the kernel notes when datagrams arrive; it begins some time after the first socket asks for it.

    Until then it gives the time of their reading instead, which says nothing of their order.
    """
    with _bound(address, 0) as probe, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        limit_s = time.monotonic() + _PROBE_LIMIT_S
        while time.monotonic() < limit_s:
            sender.sendto(b"", probe.getsockname())
            before_ns = time.time_ns()
            arrival = _receive(probe, 0, 0)
            if arrival is not None and 0 < arrival.time_ns <= before_ns:
                return


def _receive(ready: socket.socket, port: int, order: int) -> _Arrival | None:
    try:
        data, extra, _, sender = ready.recvmsg(_LONGEST, socket.CMSG_SPACE(_TIME.size))
    except (BlockingIOError, ConnectionError):
        return None
    time_ns = 0
    for level, kind, value in extra:
        if level == socket.SOL_SOCKET and kind == _TIMESTAMP and len(value) >= _TIME.size:
            seconds, nanoseconds = _TIME.unpack(value[: _TIME.size])
            time_ns = seconds * 1_000_000_000 + nanoseconds
    host, source = sender[:2]
    return _Arrival(time_ns, order, port, data, (str(host), int(source)))
