"""Receives what the controller measures: joint angles and status, which it sends unasked ten times a second."""

from __future__ import annotations

import time
from dataclasses import dataclass

from robots.drivers.abb.abb_faults import REMEDIES, AbbFault, AbbLinkError
from robots.drivers.abb.simple_message import (
    ByteOrder,
    Frame,
    JointPosition,
    MessageType,
    RobotStatus,
    SimpleMessageCodec,
)
from robots.io.wire.link_error import LinkError
from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_tap import NO_TAP, WireTap

STATE_PERIOD_S = 0.1
"""How often the program of the controller sends; it is written there."""
_READ_BYTES = 4096


@dataclass(frozen=True, kw_only=True)
class AbbReading:
    """Angles as the controller counts them, and the status that came with them."""

    joints_rad: tuple[float, ...]
    status: RobotStatus


class StateTransport:
    """Implements `DeviceTransport` over the state port; it has no commands.

    Args:
        host: Where the controller is.
        port: Its state port.
        byte_order: Of all numbers.
        timeout_s: Time limit until a measurement and a status must have come.
        tap: Notes the bytes of the connection.
    """

    def __init__(self, host: str, port: int, *, byte_order: ByteOrder, timeout_s: float, tap: WireTap = NO_TAP) -> None:
        self._where = (host, port)
        self._codec = SimpleMessageCodec(byte_order)
        self._timeout_s = timeout_s
        self._tap = tap
        self._socket: TcpConnection | None = None
        self._received = bytearray()
        self._position: JointPosition | None = None
        self._fault = AbbFault.SILENT

    @property
    def address(self) -> str:
        """Host and port."""
        return f"{self._where[0]}:{self._where[1]}"

    @property
    def remedy(self) -> str:
        """What to check when nothing comes."""
        return REMEDIES[self._fault]

    def open(self) -> None:
        """Connect."""
        self._received.clear()
        self._position = None
        try:
            self._socket = connected(self._where, self._timeout_s, self._tap)
        except AbbLinkError as error:
            self._fault = error.fault
            raise

    def close(self) -> None:
        """Disconnect."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def read(self) -> AbbReading:
        """Wait for the next status; what has piled up before the latest one is passed over."""
        limit_s = time.monotonic() + self._timeout_s
        latest: AbbReading | None = None
        try:
            while latest is None:
                for frame in self._frames(limit_s - time.monotonic()):
                    latest = self._take(frame) or latest
        except LinkError as error:
            self._fault = error.fault if isinstance(error, AbbLinkError) else AbbFault.GARBAGE
            raise
        return latest

    def write(self, command: None) -> None:
        """Do nothing: commands go to the motion port."""

    def _take(self, frame: Frame) -> AbbReading | None:
        if frame.kind == MessageType.JOINT_POSITION:
            self._position = self._codec.decode_joint_position(frame)
            return None
        status = self._codec.decode_status(frame)
        position, self._position = self._position, None
        # Without its angles, as at the beginning, a status is not a whole measurement.
        return AbbReading(joints_rad=position.joints_rad, status=status) if position is not None else None

    def _frames(self, limit_s: float) -> list[Frame]:
        connection = self._socket
        if connection is None:
            raise LinkError("not connected")
        if limit_s <= 0.0:
            raise AbbLinkError(AbbFault.SILENT, f"no state message within {self._timeout_s:g} s")
        try:
            connection.set_timeout(limit_s)
            packet = connection.receive(_READ_BYTES)
        except TimeoutError as error:
            raise AbbLinkError(AbbFault.SILENT, f"no state message within {self._timeout_s:g} s") from error
        except OSError as error:
            raise AbbLinkError(AbbFault.LINK_CUT, f"the state connection failed: {error.strerror or error}") from error
        if not packet:
            raise AbbLinkError(AbbFault.LINK_CUT, "the controller closed the state connection")
        self._received += packet
        return self._codec.split(self._received)


def connected(where: tuple[str, int], timeout_s: float, tap: WireTap) -> TcpConnection:
    """Return a connection; raises AbbLinkError."""
    try:
        return TcpConnection(where, timeout_s=timeout_s, tap=tap)
    except OSError as error:
        raise AbbLinkError(
            AbbFault.LINK_CUT, f"cannot connect to {where[0]}:{where[1]}: {error.strerror or error}"
        ) from error
