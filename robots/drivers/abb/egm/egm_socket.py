"""The UDP port to which the controller sends: the newest measurement of one controller, in the order of its numbers."""

from __future__ import annotations

import select
import socket
import time
from contextlib import suppress

from robots.drivers.abb.abb_faults import AbbFault, AbbLinkError
from robots.drivers.abb.egm.egm_messages import EgmMeasurement, EgmSetPoint, decode_measurement, encode_set_point
from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.wire_tap import NO_TAP, Address, WireTap

_MOST_BYTES = 4096
_LATE = 250
"""A number that is this much lower, or more, is that of a new session of the controller: a second of messages."""
_WRAP = 1 << 32


class EgmSocket:
    """One port here; answers go to where the last measurement came from.

    Args:
        controller: Address of the controller; packets of others are ignored.
        address: Of this computer to listen on; empty for any.
        port: UDP port here.
        tap: Notes its datagrams, those of others too.
    """

    def __init__(self, controller: str, *, address: str, port: int, tap: WireTap = NO_TAP) -> None:
        self._controller = controller
        self._place = (address, port)
        self._tap = tap
        self._socket: DatagramSocket | None = None
        self._sources: frozenset[str] = frozenset()
        self._sender: Address | None = None
        self._number: int | None = None
        self._sent = 0
        self.late = 0
        """How many measurements came after a newer one, or twice."""
        self.garbage = ""
        """Why the last packet of the controller was no measurement; empty if it was one."""

    @property
    def address(self) -> str:
        """Where it listens."""
        return f"UDP port {self._place[1]}"

    def open(self) -> None:
        """Listen; raises AbbLinkError."""
        try:
            self._sources = frozenset(
                str(found[4][0]) for found in socket.getaddrinfo(self._controller, None, socket.AF_INET)
            )
            self._socket = DatagramSocket(self._tap)
            self._socket.bind(self._place)
            self._socket.never_wait()
        except OSError as error:
            self.close()
            raise AbbLinkError(
                AbbFault.LINK_CUT, f"cannot listen on {self.address}: {error.strerror or error}"
            ) from error

    def close(self) -> None:
        """Stop listening."""
        if self._socket is not None:
            self._socket.close()
        self._socket = self._sender = self._number = None

    def receive(self, limit_s: float) -> EgmMeasurement | None:
        """Return the newest measurement that has not been returned; None if none comes within the limit."""
        end_s = time.monotonic() + limit_s
        while True:
            latest = self._drain()
            left_s = end_s - time.monotonic()
            if latest is not None or left_s <= 0.0:
                return latest
            select.select([self._opened()], [], [], left_s)

    def send(self, planned_deg: tuple[float, ...]) -> None:
        """Answer with a set point; raises AbbLinkError, and ValueError for one that is not finite."""
        self._sent += 1
        packet = encode_set_point(
            EgmSetPoint(number=self._sent, time_ms=round(time.monotonic() * 1e3), planned_deg=planned_deg)
        )
        if self._sender is None:
            raise AbbLinkError(AbbFault.SILENT, "the controller has sent nothing yet")
        try:
            self._opened().send(packet, self._sender)
        except BlockingIOError:
            pass  # this one is lost, as on the wire
        except OSError as error:
            raise AbbLinkError(AbbFault.LINK_CUT, f"nothing can be sent to it: {error.strerror or error}") from error

    def _drain(self) -> EgmMeasurement | None:
        latest: EgmMeasurement | None = None
        # An answer to a port that was closed comes back as an error of the next call: it is no measurement.
        with suppress(BlockingIOError):
            while True:
                try:
                    packet, sender = self._opened().receive_from(_MOST_BYTES)
                except ConnectionRefusedError:
                    continue
                if sender[0] in self._sources:
                    latest = self._take(packet, sender) or latest
        return latest

    def _take(self, packet: bytes, sender: Address) -> EgmMeasurement | None:
        try:
            measurement = decode_measurement(packet)
        except AbbLinkError as error:
            self.garbage = str(error)
            return None
        self.garbage = ""
        behind = (self._number - measurement.number) % _WRAP if self._number is not None else _WRAP
        if behind < _LATE:
            self.late += 1
            return None
        self._number, self._sender = measurement.number, sender
        return measurement

    def _opened(self) -> DatagramSocket:
        if self._socket is None:
            raise AbbLinkError(AbbFault.LINK_CUT, "not listening")
        return self._socket
