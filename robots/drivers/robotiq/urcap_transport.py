"""The gripper through the text server of the Robotiq URCap on a UR controller."""

from __future__ import annotations

from collections.abc import Callable

from robots.drivers.robotiq.gripper_registers import GripperCommand, GripperStatus
from robots.drivers.robotiq.robotiq_options import UrcapSocket
from robots.drivers.robotiq.urcap_codec import (
    ACKNOWLEDGED,
    NOT_UNDERSTOOD,
    STATUS_NAMES,
    decode_reply,
    encode_get,
    encode_set,
    status_of,
)
from robots.io.wire.link_error import LinkError
from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_tap import NO_TAP, WireTap

_MOST_BYTES = 256
_SHOWN_BYTES = 12


class UrcapTransport:
    """Implements `DeviceTransport` over the text protocol.

    Args:
        connection: Where the server is.
        timeout_s: Time limit of each request.
        tap: Notes the bytes of the connection.
    """

    def __init__(self, connection: UrcapSocket, *, timeout_s: float, tap: WireTap = NO_TAP) -> None:
        self._connection = connection
        self._timeout_s = timeout_s
        self._tap = tap
        self._socket: TcpConnection | None = None

    @property
    def address(self) -> str:
        """Host and port."""
        return f"{self._connection.host}:{self._connection.port}"

    @property
    def remedy(self) -> str:
        """What to check when it does not answer."""
        return "check that the UR controller is on, its Robotiq URCap is installed, and the gripper is configured in it"

    def open(self) -> None:
        """Connect; commands nothing."""
        try:
            self._socket = TcpConnection(
                (self._connection.host, self._connection.port), timeout_s=self._timeout_s, tap=self._tap
            )
        except OSError as error:
            raise LinkError(f"cannot connect: {error.strerror or error}") from error

    def close(self) -> None:
        """Disconnect."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def read(self) -> GripperStatus:
        """Ask for all variables of the status."""
        return status_of({name: decode_reply(name, self._line(encode_get(name))) for name in STATUS_NAMES})

    def write(self, command: GripperCommand) -> None:
        """Set all variables of a command."""
        reply = self._exchange(
            encode_set(command), lambda reply: len(reply) >= len(ACKNOWLEDGED) or reply == NOT_UNDERSTOOD
        )
        if reply.strip() != ACKNOWLEDGED:
            raise LinkError(f"SET was answered with {reply[:16]!r}")

    def _line(self, request: bytes) -> bytes:
        return self._exchange(request, lambda reply: reply.endswith(b"\n") or reply == NOT_UNDERSTOOD)

    def _exchange(self, request: bytes, complete: Callable[[bytes], bool]) -> bytes:
        connection = self._socket
        if connection is None:
            raise LinkError("not connected")
        reply = b""
        try:
            connection.send(request)
            while not complete(reply):
                received = connection.receive(_MOST_BYTES)
                if not received:
                    raise LinkError("the connection was closed by the device")
                reply += received
                if len(reply) > _MOST_BYTES:
                    raise LinkError(f"the answer has no end: {reply[:16]!r}")
        except TimeoutError as error:
            garbage = f", but bytes that are no answer: {reply[:_SHOWN_BYTES].hex(' ')}" if reply else ""
            raise LinkError(f"no valid answer within {self._timeout_s:g} s{garbage}") from error
        except OSError as error:
            raise LinkError(f"the connection failed: {error.strerror or error}") from error
        return reply
