"""Modbus requests and replies as bytes, the server's side, written from the specification and not from pymodbus.

RTU: unit, function, data, CRC-16 with the low byte first. TCP: transaction, protocol 0, length, the same without CRC.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

READ_HOLDING, READ_INPUT, WRITE_MANY, READ_WRITE = 0x03, 0x04, 0x10, 0x17
ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE, DEVICE_FAILURE = 1, 2, 3, 4
_MOST_WORDS = 125
_MBAP = 6
_LONGEST = 260


@dataclass(frozen=True, kw_only=True)
class RegisterRequest:
    """One request: words to read from `read_from`, words to write to `write_to`; `failure` is why it is refused."""

    unit: int
    function: int
    read_from: int = 0
    read_count: int = 0
    write_to: int = 0
    values: tuple[int, ...] = ()
    failure: int = 0


def crc16(data: bytes) -> int:
    """Return the CRC of Modbus RTU."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc


def with_crc(data: bytes) -> bytes:
    """Return an RTU frame."""
    return data + struct.pack("<H", crc16(data))


def take_rtu_request(buffer: bytearray) -> RegisterRequest | None:
    """Remove the first request from a buffer and return it; None while it is incomplete.

    A frame with a wrong CRC ends the buffer: on a serial line the pause behind it would.
    """
    size = _rtu_size(buffer)
    if size is None or len(buffer) < size:
        return None
    frame, rest = bytes(buffer[:size]), bytes(buffer[size:])
    buffer.clear()
    if struct.unpack("<H", frame[-2:])[0] != crc16(frame[:-2]):
        return None
    buffer.extend(rest)
    return decode_request(frame[:-2])


def take_tcp_request(buffer: bytearray) -> tuple[int, RegisterRequest] | None:
    """Remove the first request from a buffer and return it with its transaction; None while it is incomplete."""
    if len(buffer) < _MBAP:
        return None
    transaction, protocol, length = struct.unpack(">HHH", buffer[:_MBAP])
    if protocol != 0 or not 2 <= length <= _LONGEST:
        buffer.clear()
        return None
    if len(buffer) < _MBAP + length:
        return None
    frame = bytes(buffer[_MBAP : _MBAP + length])
    del buffer[: _MBAP + length]
    return transaction, decode_request(frame)


def decode_request(frame: bytes) -> RegisterRequest:
    """Return the request in unit, function and data."""
    unit, function, data = frame[0], frame[1], frame[2:]
    try:
        if function in (READ_HOLDING, READ_INPUT):
            read_from, count = struct.unpack(">HH", data)
            return _checked(RegisterRequest(unit=unit, function=function, read_from=read_from, read_count=count))
        if function == WRITE_MANY:
            write_to, count, size = struct.unpack(">HHB", data[:5])
            values = struct.unpack(f">{count}H", data[5:])
            failure = ILLEGAL_VALUE if size != 2 * count or not count else 0
            return RegisterRequest(unit=unit, function=function, write_to=write_to, values=values, failure=failure)
        if function == READ_WRITE:
            read_from, read_count, write_to, count, size = struct.unpack(">HHHHB", data[:9])
            values = struct.unpack(f">{count}H", data[9:])
            request = RegisterRequest(
                unit=unit,
                function=function,
                read_from=read_from,
                read_count=read_count,
                write_to=write_to,
                values=values,
                failure=ILLEGAL_VALUE if size != 2 * count or not count else 0,
            )
            return _checked(request)
    except struct.error:
        return RegisterRequest(unit=unit, function=function, failure=ILLEGAL_VALUE)
    return RegisterRequest(unit=unit, function=function, failure=ILLEGAL_FUNCTION)


def encode_reply(request: RegisterRequest, words: tuple[int, ...]) -> bytes:
    """Return unit, function and data of a reply with the words that were read."""
    if request.function == WRITE_MANY:
        return struct.pack(">BBHH", request.unit, request.function, request.write_to, len(request.values))
    return struct.pack(f">BBB{len(words)}H", request.unit, request.function, 2 * len(words), *words)


def encode_refusal(request: RegisterRequest, failure: int) -> bytes:
    """Return unit, function and code of an exception."""
    return bytes((request.unit, request.function | 0x80, failure))


def with_mbap(transaction: int, data: bytes) -> bytes:
    """Return a frame of Modbus TCP."""
    return struct.pack(">HHH", transaction, 0, len(data)) + data


def _checked(request: RegisterRequest) -> RegisterRequest:
    if request.failure or 1 <= request.read_count <= _MOST_WORDS:
        return request
    return RegisterRequest(unit=request.unit, function=request.function, failure=ILLEGAL_VALUE)


def _rtu_size(buffer: bytearray) -> int | None:
    """Return the length of the frame that begins a buffer; None while it is not known."""
    if len(buffer) < 2:
        return None
    function = buffer[1]
    if function in (WRITE_MANY, READ_WRITE):
        place = 6 if function == WRITE_MANY else 10
        return place + 3 + buffer[place] if len(buffer) > place else None
    return 8
