"""The messages of the Franka Hand, version 3 of its protocol; little endian, as libfranka sends and receives them."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from enum import IntEnum

from robots.io.wire.link_error import LinkError

HAND_PORT = 1338
HAND_VERSION = 3
HEADER = struct.Struct("<HII")
_CONNECT_REQUEST = struct.Struct("<HH")
_CONNECT_REPLY = struct.Struct("<HH")
_STATUS = struct.Struct("<H")
_GRASP = struct.Struct("<ddddd")
_MOVE = struct.Struct("<dd")
STATE = struct.Struct("<IddBH")
_LONGEST = 1024


class HandRequest(IntEnum):
    """The code of a request, and of its reply."""

    CONNECT = 0
    HOMING = 1
    GRASP = 2
    MOVE = 3
    STOP = 4


_CODES = frozenset(int(request) for request in HandRequest)


class HandReply(IntEnum):
    """How a request has ended."""

    SUCCESS = 0
    FAIL = 1
    UNSUCCESSFUL = 2
    ABORTED = 3


@dataclass(frozen=True, kw_only=True)
class FingerState:
    """What the hand measures; `stroke_m` is 0 until it was homed."""

    number: int
    width_m: float
    stroke_m: float
    is_grasping: bool
    temperature_c: int


@dataclass(frozen=True, kw_only=True)
class HandMessage:
    """One message of the hand: which request it is about, and its end."""

    request: HandRequest
    number: int
    payload: bytes

    @property
    def status(self) -> int:
        """The first word of the payload."""
        if len(self.payload) < _STATUS.size:
            raise LinkError(f"the hand answered {self.request.name} with {self.payload.hex(' ') or 'nothing'}")
        return int(_STATUS.unpack_from(self.payload)[0])

    def require_connection(self) -> None:
        """Raise LinkError where the hand refuses the connection."""
        if len(self.payload) < _CONNECT_REPLY.size:
            raise LinkError(f"the hand answered CONNECT with {self.payload.hex(' ') or 'nothing'}")
        status, version = _CONNECT_REPLY.unpack_from(self.payload)
        if status != HandReply.SUCCESS:
            raise LinkError(f"wrong version: the hand speaks version {version} of its protocol, not {HAND_VERSION}")


def encode_connect(number: int, *, udp_port: int) -> bytes:
    """Return the request that the hand sends its states to a UDP port."""
    return _message(HandRequest.CONNECT, number, _CONNECT_REQUEST.pack(HAND_VERSION, udp_port))


def encode_homing(number: int) -> bytes:
    """Return the request to open and close once, which measures the stroke."""
    return _message(HandRequest.HOMING, number)


def encode_stop(number: int) -> bytes:
    """Return the request to stop."""
    return _message(HandRequest.STOP, number)


def encode_move(number: int, *, width_m: float, speed_m_s: float) -> bytes:
    """Return the request to move to an opening."""
    return _message(HandRequest.MOVE, number, _MOVE.pack(width_m, speed_m_s))


def encode_grasp(
    number: int, *, width_m: float, inner_m: float, outer_m: float, speed_m_s: float, force_n: float
) -> bytes:
    """Return the request to close on something between `width_m - inner_m` and `width_m + outer_m`."""
    return _message(HandRequest.GRASP, number, _GRASP.pack(width_m, inner_m, outer_m, speed_m_s, force_n))


def decode_state(datagram: bytes) -> FingerState | None:
    """Return the state of a datagram; None for another one, and for one whose widths are no numbers."""
    if len(datagram) != STATE.size:
        return None
    number, width_m, stroke_m, is_grasping, temperature_c = STATE.unpack(datagram)
    if not (math.isfinite(width_m) and math.isfinite(stroke_m)):
        return None
    return FingerState(
        number=number,
        width_m=width_m,
        stroke_m=stroke_m,
        is_grasping=bool(is_grasping),
        temperature_c=temperature_c,
    )


def take_message(buffer: bytearray) -> HandMessage | None:
    """Remove the first message of received bytes and return it; None while it is not complete.

    Raises:
        LinkError: the bytes are no message.
    """
    if len(buffer) < HEADER.size:
        return None
    code, number, size = HEADER.unpack_from(buffer)
    if not HEADER.size <= size <= _LONGEST or code not in _CODES:
        raise LinkError(f"the hand sent bytes that are no message: {bytes(buffer[:16]).hex(' ')}")
    if len(buffer) < size:
        return None
    payload = bytes(buffer[HEADER.size : size])
    del buffer[:size]
    return HandMessage(request=HandRequest(code), number=number, payload=payload)


def _message(request: HandRequest, number: int, payload: bytes = b"") -> bytes:
    return HEADER.pack(request, number, HEADER.size + len(payload)) + payload
