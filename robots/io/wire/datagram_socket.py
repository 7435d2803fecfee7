"""A UDP socket over IPv4; its datagrams can be captured."""

from __future__ import annotations

import socket

from robots.io.wire.tcp_connection import address_of
from robots.io.wire.wire_tap import Address, WireEndpoints, WireTap


class DatagramSocket:
    """Open from its construction on; what fails raises OSError.

    Args:
        tap: Notes its datagrams.
    """

    def __init__(self, tap: WireTap) -> None:
        self._tap = tap
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def fileno(self) -> int:
        """Return the file descriptor, for `select`."""
        return self._socket.fileno()

    @property
    def port(self) -> int:
        """Where it receives; 0 before `bind`."""
        return address_of(self._socket.getsockname())[1]

    def never_wait(self) -> None:
        """Let calls fail that would wait."""
        self._socket.setblocking(False)

    def bind(self, address: Address) -> None:
        """Receive at an address and port."""
        self._socket.bind(address)

    def permit_broadcast(self) -> None:
        """Permit sending to broadcast addresses."""
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)

    def send(self, data: bytes, to: Address) -> None:
        """Send a datagram."""
        self._socket.sendto(data, to)
        if self._tap.is_active:
            # Of a name the address: a captured datagram has no other.
            remote = (socket.gethostbyname(to[0]), to[1])
            self._tap.sent(data, WireEndpoints(local=address_of(self._socket.getsockname()), remote=remote))

    def receive(self, most: int) -> bytes:
        """Return the next datagram."""
        return self.receive_from(most)[0]

    def receive_from(self, most: int) -> tuple[bytes, Address]:
        """Return the next datagram, and who sent it."""
        data, sender = self._socket.recvfrom(most)
        if self._tap.is_active:
            ends = WireEndpoints(local=address_of(self._socket.getsockname()), remote=address_of(sender))
            self._tap.received(data, ends)
        return data, address_of(sender)

    def close(self) -> None:
        """Close it."""
        self._socket.close()
