"""The messages of Externally Guided Motion: two of protobuf, without its library; knows no socket."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum

from robots.drivers.abb.abb_faults import AbbFault, AbbLinkError

AXES = 6
_VARINT, _FIXED64, _BYTES, _FIXED32 = 0, 1, 2, 5
_DOUBLE = struct.Struct("<d")
_MOST_BITS = 64
_MOST_BYTES = 4096

Field = tuple[int, int, int | bytes]


class MciState(IntEnum):
    """Whether the controller follows set points."""

    UNDEFINED = 0
    ERROR = 1
    STOPPED = 2
    RUNNING = 3


class MotorState(IntEnum):
    """Whether the motors are on."""

    UNDEFINED = 0
    ON = 1
    OFF = 2


class RapidState(IntEnum):
    """Whether the program runs."""

    UNDEFINED = 0
    STOPPED = 1
    RUNNING = 2


class MessageKind(IntEnum):
    """`mtype` of a header."""

    UNDEFINED = 0
    COMMAND = 1
    DATA = 2
    CORRECTION = 3
    PATH_CORRECTION = 4


@dataclass(frozen=True, kw_only=True)
class EgmMeasurement:
    """What the controller measures: `EgmRobot`.

    Attributes:
        number: Of the message, 32 bits.
        time_ms: The controller's clock, 32 bits.
        measured_deg: Angles of the axes as the controller counts them.
        planned_deg: Those that it holds or goes to; None without.
        motors: Whether they are on.
        mci: Whether it follows set points.
        rapid: Whether its program runs.
    """

    number: int
    time_ms: int
    measured_deg: tuple[float, ...]
    planned_deg: tuple[float, ...] | None = None
    motors: MotorState = MotorState.UNDEFINED
    mci: MciState = MciState.UNDEFINED
    rapid: RapidState = RapidState.UNDEFINED


@dataclass(frozen=True, kw_only=True)
class EgmSetPoint:
    """What the axes are to go to: `EgmSensor`."""

    number: int
    time_ms: int
    planned_deg: tuple[float, ...]


def encode_measurement(measurement: EgmMeasurement) -> bytes:
    """Return the packet of a measurement."""
    packet = _message(1, _header(measurement.number, measurement.time_ms, MessageKind.DATA))
    packet += _message(2, _message(1, _doubles(measurement.measured_deg)))
    if measurement.planned_deg is not None:
        packet += _message(3, _message(1, _doubles(measurement.planned_deg)))
    packet += _message(4, _number(1, measurement.motors)) + _message(5, _number(1, measurement.mci))
    return packet + _message(8, _number(1, measurement.rapid))


def decode_measurement(packet: bytes) -> EgmMeasurement:
    """Return the measurement in a packet; raises AbbLinkError for anything else."""
    fields = dict[int, bytes]()
    for number, kind, value in _fields(packet):
        if kind == _BYTES and isinstance(value, bytes):
            fields[number] = value
    header = _numbers(fields.get(1, b""))
    measured = _joints(_inner(fields.get(2, b""), 1))
    if len(measured) != AXES:
        raise _garbage(f"{len(measured)} measured axes")
    planned = _joints(_inner(fields.get(3, b""), 1))
    try:
        return EgmMeasurement(
            number=header[1],
            time_ms=header[2],
            measured_deg=measured,
            planned_deg=planned if len(planned) == AXES else None,
            motors=MotorState(_numbers(fields.get(4, b"")).get(1, 0)),
            mci=MciState(_numbers(fields.get(5, b"")).get(1, 0)),
            rapid=RapidState(_numbers(fields.get(8, b"")).get(1, 0)),
        )
    except KeyError as error:
        raise _garbage("a header without number or time") from error
    except ValueError as error:
        raise _garbage(str(error)) from error


def renumber_measurement(packet: bytes, *, by: int, time_ms: int) -> bytes:
    """Return the packet of a measurement so many messages and milliseconds later; the rest of it stays as it is.

    Raises:
        AbbLinkError: it is no measurement.
    """
    measurement = decode_measurement(packet)
    numbers = (measurement.number + by, measurement.time_ms + time_ms)
    # Of a field that comes twice the last one counts.
    return packet + _message(1, _header(*numbers, MessageKind.DATA))


def encode_set_point(set_point: EgmSetPoint) -> bytes:
    """Return the packet of a set point; raises ValueError for values that are not finite."""
    if len(set_point.planned_deg) != AXES or not all(map(math.isfinite, set_point.planned_deg)):
        raise ValueError(f"{set_point.planned_deg} is no set point of {AXES} axes")
    header = _header(set_point.number, set_point.time_ms, MessageKind.CORRECTION)
    return _message(1, header) + _message(2, _message(1, _doubles(set_point.planned_deg)))


def decode_set_point(packet: bytes) -> EgmSetPoint:
    """Return the set point in a packet; raises AbbLinkError for anything else."""
    fields = {number: value for number, kind, value in _fields(packet) if kind == _BYTES and isinstance(value, bytes)}
    header = _numbers(fields.get(1, b""))
    joints = _joints(_inner(fields.get(2, b""), 1))
    if header.get(3) != MessageKind.CORRECTION or len(joints) != AXES:
        raise _garbage("a packet that is no set point of the axes")
    return EgmSetPoint(number=header.get(1, 0), time_ms=header.get(2, 0), planned_deg=joints)


def _header(number: int, time_ms: int, kind: MessageKind) -> bytes:
    return _number(1, number & 0xFFFFFFFF) + _number(2, time_ms & 0xFFFFFFFF) + _number(3, kind)


def _doubles(values: tuple[float, ...]) -> bytes:
    return b"".join(_varint(1 << 3 | _FIXED64) + _DOUBLE.pack(value) for value in values)


def _message(field: int, content: bytes) -> bytes:
    return _varint(field << 3 | _BYTES) + _varint(len(content)) + content


def _number(field: int, value: int) -> bytes:
    return _varint(field << 3 | _VARINT) + _varint(value)


def _varint(value: int) -> bytes:
    encoded = bytearray()
    while value > 0x7F:
        encoded.append(value & 0x7F | 0x80)
        value >>= 7
    encoded.append(value)
    return bytes(encoded)


def _fields(content: bytes) -> Iterator[Field]:
    """Yield number, wire type and value of each field; raises AbbLinkError."""
    if len(content) > _MOST_BYTES:
        raise _garbage(f"{len(content)} bytes")
    at = 0
    while at < len(content):
        key, at = _read_varint(content, at)
        number, kind = key >> 3, key & 7
        if kind == _VARINT:
            value, at = _read_varint(content, at)
            yield number, kind, value
            continue
        if kind == _BYTES:
            length, at = _read_varint(content, at)
        elif kind in (_FIXED64, _FIXED32):
            length = 8 if kind == _FIXED64 else 4
        else:
            raise _garbage(f"a field of wire type {kind}")
        if at + length > len(content):
            raise _garbage("a packet that ends within a field")
        yield number, kind, content[at : at + length]
        at += length


def _read_varint(content: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        if at >= len(content) or shift >= _MOST_BITS:
            raise _garbage("a number without an end")
        byte = content[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at


def _numbers(content: bytes) -> dict[int, int]:
    return {number: value for number, _, value in _fields(content) if isinstance(value, int)}


def _inner(content: bytes, field: int) -> bytes:
    """Return the last message in a field; empty without one."""
    inner = [value for number, kind, value in _fields(content) if number == field and kind == _BYTES]
    return inner[-1] if inner and isinstance(inner[-1], bytes) else b""


def _joints(content: bytes) -> tuple[float, ...]:
    """Return repeated doubles, packed or not; raises AbbLinkError for values that are not finite."""
    values: list[float] = []
    for number, _, value in _fields(content):
        if number == 1 and isinstance(value, bytes):
            if len(value) % _DOUBLE.size:
                raise _garbage("angles that are no doubles")
            values += (each for (each,) in _DOUBLE.iter_unpack(value))
    if not all(map(math.isfinite, values)):
        raise _garbage("angles that are not finite")
    return tuple(values)


def _garbage(detail: str) -> AbbLinkError:
    return AbbLinkError(AbbFault.GARBAGE, f"EGM sent {detail}")
