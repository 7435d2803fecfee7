"""The frames of a qb SoftHand: `::`, address, length, command, data, checksum; knows no line."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from robots.io.wire.link_error import LinkError

_START = b"::"
_HEADER_BYTES = 4
_WORD = 2


class HandCommandCode(IntEnum):
    """The commands that are used here."""

    PING = 0
    ACTIVATE = 128
    GET_ACTIVATE = 129
    SET_INPUTS = 130
    GET_INPUTS = 131
    GET_MEASUREMENTS = 132
    GET_CURRENTS = 133
    GET_CURRENTS_AND_MEASUREMENTS = 134


MOTORS_ON, MOTORS_OFF = b"\x03", b"\x00"


@dataclass(frozen=True, kw_only=True)
class HandFrame:
    """One frame without its start and checksum."""

    unit: int
    command: int
    data: bytes = b""


class ChecksumError(LinkError):
    """A frame has another checksum than its bytes."""


def encode_frame(frame: HandFrame) -> bytes:
    """Return the bytes of a frame.

    Raises:
        ValueError: address or command is no byte, or the data are too long.
    """
    body = bytes((frame.command,)) + frame.data
    return _START + bytes((frame.unit, len(body) + 1)) + body + bytes((_checksum(body),))


def take_frame(buffer: bytearray) -> HandFrame | None:
    """Remove the first complete frame and what is before it; None while there is none.

    Raises:
        ChecksumError: its checksum is wrong; the frame is removed.
    """
    while (start := buffer.find(_START)) >= 0:
        del buffer[:start]
        if len(buffer) < _HEADER_BYTES:
            return None
        unit, length = buffer[2], buffer[3]
        if length < _WORD:
            # No frame is that short: what looked like a start was none.
            del buffer[:1]
            continue
        end = _HEADER_BYTES + length
        if len(buffer) < end:
            return None
        body, checksum = bytes(buffer[_HEADER_BYTES : end - 1]), buffer[end - 1]
        del buffer[:end]
        if _checksum(body) != checksum:
            raise ChecksumError(f"the checksum of a frame is {checksum:#04x} instead of {_checksum(body):#04x}")
        return HandFrame(unit=unit, command=body[0], data=body[1:])
    # The last byte may be the first half of a start.
    del buffer[: len(buffer) - (1 if buffer.endswith(_START[:1]) else 0)]
    return None


def encode_words(*words: int) -> bytes:
    """Return signed 16-bit words; raises OverflowError for a number that is none."""
    return b"".join(word.to_bytes(_WORD, signed=True) for word in words)


def decode_words(data: bytes, count: int) -> tuple[int, ...]:
    """Return `count` signed 16-bit words.

    Raises:
        LinkError: there are more or fewer.
    """
    if len(data) != _WORD * count:
        raise LinkError(f"{len(data)} bytes are not the {count} words that were asked for")
    return tuple(int.from_bytes(data[start : start + _WORD], signed=True) for start in range(0, len(data), _WORD))


def _checksum(body: bytes) -> int:
    checksum = 0
    for byte in body:
        checksum ^= byte
    return checksum
