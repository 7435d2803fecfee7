"""How the requests of each protocol are told apart, and which of them may be repeated or left out in a replay.

A driver polls as often as its time allows, and its set points depend on time too: in a replay there are others than
in the capture. Its commands are the same ones in the same order.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum

from robots.drivers.franka_hand.hand_protocol import HEADER
from robots.drivers.replay.hand_states import without_port
from robots.drivers.softhand.hand_frames import HandCommandCode, HandFrame, encode_frame


class RequestKind(Enum):
    """What a replay requires of a request: exactly the recorded one; any number of them; any values."""

    COMMAND = "command"
    POLL = "poll"
    SET_POINT = "set point"


@dataclass(frozen=True, kw_only=True)
class RequestRule:
    """The requests of one protocol.

    Attributes:
        length: Returns the length of the first request in received bytes; 0 while it is not complete.
        kind: Returns the kind of a request.
        number_bytes: So many bytes at the beginning number the request, and its answer repeats them.
        compared: Returns what of a request has to be the recorded one: not what differs from session to session.
        echo: Returns the answer to a poll that repeats a set point, which the driver compares with what it sent.
    """

    length: Callable[[bytes], int] = len
    kind: Callable[[bytes], RequestKind] = lambda _: RequestKind.COMMAND
    number_bytes: int = 0
    compared: Callable[[bytes], bytes] = lambda request: request
    echo: Callable[[bytes], bytes] | None = None

    def split(self, data: bytes) -> list[bytes]:
        """Return the requests in recorded bytes; what is not complete is one too."""
        requests: list[bytes] = []
        while data:
            size = self.length(data) or len(data)
            requests.append(data[:size])
            data = data[size:]
        return requests

    def key(self, request: bytes) -> bytes:
        """Return what two requests that are the same share; that of set points is the same for all."""
        return b"" if self.kind(request) is RequestKind.SET_POINT else self.compared(request)[self.number_bytes :]

    def answer(self, reply: bytes, request: bytes) -> bytes:
        """Return a recorded reply as one to this request."""
        return request[: self.number_bytes] + reply[self.number_bytes :]


_WRITES = (0x10, 0x17)


def _line_length(data: bytes) -> int:
    return data.find(b"\n") + 1


def _modbus_tcp_length(data: bytes) -> int:
    size = 6 + struct.unpack_from(">H", data, 4)[0] if len(data) >= 6 else 0
    return size if size and len(data) >= size else 0


def _modbus_rtu_length(data: bytes) -> int:
    if len(data) < 8:
        return 0
    match data[1]:
        case 0x10:
            size = 9 + data[6]
        case 0x17 if len(data) > 10:
            size = 13 + data[10]
        case 0x17:
            return 0
        case _:
            size = 8
    return size if len(data) >= size else 0


def _hand_length(data: bytes) -> int:
    size = 4 + data[3] if len(data) >= 4 else 0
    return size if size and len(data) >= size else 0


def _message_length(data: bytes) -> int:
    if len(data) < 4:
        return 0
    little, big = int.from_bytes(data[:4], "little"), int.from_bytes(data[:4], "big")
    size = 4 + min(little, big)
    return size if len(data) >= size else 0


def _modbus_kind(function: int) -> RequestKind:
    return RequestKind.COMMAND if function in _WRITES else RequestKind.POLL


def _hand_kind(request: bytes) -> RequestKind:
    match request[4]:
        case HandCommandCode.ACTIVATE:
            return RequestKind.COMMAND
        case HandCommandCode.SET_INPUTS:
            return RequestKind.SET_POINT
        case _:
            return RequestKind.POLL


def _hand_echo(set_point: bytes) -> bytes:
    frame = HandFrame(unit=set_point[2], command=HandCommandCode.GET_INPUTS, data=set_point[5:-1])
    return encode_frame(frame)


def _servo_kind(request: bytes) -> RequestKind:
    if request.strip() == b"?":
        return RequestKind.POLL
    return RequestKind.COMMAND if request[:1].isalpha() else RequestKind.SET_POINT


def _rtde_length(data: bytes) -> int:
    size = int.from_bytes(data[:2], "big") if len(data) >= 3 else 0
    return size if size and len(data) >= size else 0


def _rtde_kind(request: bytes) -> RequestKind:
    return RequestKind.SET_POINT if request[2:3] == b"U" else RequestKind.COMMAND


def _franka_hand_length(data: bytes) -> int:
    size = HEADER.unpack_from(data)[2] if len(data) >= HEADER.size else 0
    return size if size and len(data) >= size else 0


def _program_length(data: bytes) -> int:
    end = data.find(b"\nend\n")
    return end + 5 if end >= 0 else 0


def _without_session(program: bytes) -> bytes:
    return re.sub(rb"session = \d+", b"session", program)


def _http_length(data: bytes) -> int:
    head, end, _ = data.partition(b"\r\n\r\n")
    if not end:
        return 0
    found = _CONTENT_LENGTH.search(head)
    size = len(head) + len(end) + (int(found[1]) if found is not None else 0)
    return size if len(data) >= size else 0


def _http_kind(request: bytes) -> RequestKind:
    return RequestKind.POLL if request.startswith(b"GET ") else RequestKind.COMMAND


def _without_headers(request: bytes) -> bytes:
    head, _, body = request.partition(b"\r\n\r\n")
    return head.partition(b"\r\n")[0] + b"\n" + body


_CONTENT_LENGTH = re.compile(rb"(?i)\r\ncontent-length: *(\d{1,9})")
_PROGRAMS = RequestRule(length=_program_length, compared=_without_session)
_LINES = RequestRule(length=_line_length)
_MODBUS_RTU = RequestRule(length=_modbus_rtu_length, kind=lambda request: _modbus_kind(request[1]))

REQUEST_RULES: Mapping[str, RequestRule] = {
    "modbus_rtu": _MODBUS_RTU,
    "rtu_over_tcp": _MODBUS_RTU,
    "modbus_tcp": RequestRule(length=_modbus_tcp_length, kind=lambda request: _modbus_kind(request[7]), number_bytes=2),
    "urcap": RequestRule(
        length=_line_length,
        kind=lambda request: RequestKind.POLL if request.startswith(b"GET ") else RequestKind.COMMAND,
    ),
    "softhand": RequestRule(length=_hand_length, kind=_hand_kind, echo=_hand_echo),
    "servo_lines": RequestRule(length=_line_length, kind=_servo_kind),
    "simple_message_state": RequestRule(length=_message_length),
    "simple_message_motion": RequestRule(length=_message_length),
    "gripper_text": RequestRule(),
    # Of headers, address, credentials and cookies are others in each session.
    "rws": RequestRule(length=_http_length, kind=_http_kind, compared=_without_headers),
    "rws_stop": RequestRule(length=_http_length, kind=_http_kind, compared=_without_headers),
    "ur_dashboard": _LINES,
    "ur_secondary": _PROGRAMS,
    "ur_script": _PROGRAMS,
    "ur_outputs": RequestRule(length=_rtde_length),
    "ur_inputs": RequestRule(length=_rtde_length, kind=_rtde_kind),
    "hand_commands": RequestRule(length=_franka_hand_length, compared=without_port),
}
"""By protocol. Others are replayed strictly: all that was sent has to be sent again."""
NOT_REPLAYED: Mapping[str, tuple[str, str]] = {
    "reconcell_server": (
        "it was captured by the server: its client's commands would be sent to the arm that is served",
        "capture its client: `ReconcellClient(capture=…)`",
    ),
    "hand_states": (
        "the states of a hand belong to its requests",
        "name both: file=….hand_commands.….pcapng states=….hand_states.….pcapng port=1338",
    ),
}
"""By protocol, why a capture of it is not played back, and what to do."""
STRICT = RequestRule()
