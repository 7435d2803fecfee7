"""Packets of RTDE protocol 2: big-endian, each with its size and type in front."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

HEADER = struct.Struct(">HB")
PROTOCOL_VERSION = 2
NOT_FOUND = "NOT_FOUND"
IN_USE = "IN_USE"


class RtdePacketType(IntEnum):
    """The letter that a packet begins with, behind its size."""

    PROTOCOL_VERSION = ord("V")
    CONTROLLER_VERSION = ord("v")
    SETUP_OUTPUTS = ord("O")
    SETUP_INPUTS = ord("I")
    START = ord("S")
    PAUSE = ord("P")
    DATA = ord("U")
    TEXT_MESSAGE = ord("M")


class RtdeMessageLevel(IntEnum):
    """How bad the event of a text message is."""

    EXCEPTION = 0
    ERROR = 1
    WARNING = 2
    INFO = 3


VALUE_FORMATS = {
    "BOOL": "?",
    "UINT8": "B",
    "UINT32": "I",
    "UINT64": "Q",
    "INT32": "i",
    "DOUBLE": "d",
    "VECTOR3D": "3d",
    "VECTOR6D": "6d",
    "VECTOR6INT32": "6i",
    "VECTOR6UINT32": "6I",
}
"""The format of each type of a variable, in the letters of `struct`."""

RtdeValue = bool | int | float | tuple[int, ...] | tuple[float, ...]


class RtdePacketError(ValueError):
    """Bytes that are no packet of RTDE; says which."""


@dataclass(frozen=True, slots=True)
class RtdePacket:
    """One packet: its type, which may be unknown, and its payload."""

    kind: int
    payload: bytes = b""

    def encode(self) -> bytes:
        """Return the bytes on the wire."""
        size = HEADER.size + len(self.payload)
        if size > 0xFFFF:
            raise RtdePacketError(f"a packet of {size} bytes is longer than its size field can say")
        return HEADER.pack(size, self.kind) + self.payload


def split_packets(received: bytearray) -> list[RtdePacket]:
    """Take the complete packets off the front of the received bytes; raise RtdePacketError where none can begin."""
    packets: list[RtdePacket] = []
    while len(received) >= HEADER.size:
        size, kind = HEADER.unpack_from(received)
        if size < HEADER.size:
            raise RtdePacketError(f"a packet says that it has {size} bytes; its header alone has {HEADER.size}")
        if len(received) < size:
            break
        packets.append(RtdePacket(kind, bytes(received[HEADER.size : size])))
        del received[:size]
    return packets


def read_names(payload: bytes) -> list[str]:
    """Return the names of a recipe; a comma may follow the last one."""
    try:
        text = payload.decode("ascii")
    except UnicodeDecodeError:
        raise RtdePacketError("the names of a recipe are not ASCII") from None
    return text.removesuffix(",").split(",") if text else []


def read_frequency(payload: bytes) -> tuple[float, bytes]:
    """Return the frequency that a client asks for, and the names behind it."""
    if len(payload) < 8:
        raise RtdePacketError(f"a set-up of outputs has {len(payload)} bytes; its frequency alone has 8")
    return struct.unpack_from(">d", payload)[0], payload[8:]


def recipe_reply(recipe: int, types: Sequence[str]) -> bytes:
    """Return the payload that answers the set-up of a recipe; recipe 0 means refused."""
    return bytes([recipe]) + ",".join(types).encode("ascii")


def text_message(text: str, source: str, level: RtdeMessageLevel) -> RtdePacket:
    """Return a message of the controller; what is longer than 255 bytes is cut."""
    parts = [part.encode("ascii", "replace")[:255] for part in (text, source)]
    body = b"".join(bytes([len(part)]) + part for part in parts)
    return RtdePacket(RtdePacketType.TEXT_MESSAGE, body + bytes([level]))


class RecipeCodec:
    """Packs and unpacks the values of one recipe, in the order of its types."""

    def __init__(self, recipe: int, types: Sequence[str]) -> None:
        self.recipe = recipe
        self._counts = [int(form[:-1] or 1) for form in (VALUE_FORMATS[kind] for kind in types)]
        self._struct = struct.Struct(">B" + "".join(VALUE_FORMATS[kind] for kind in types))

    def pack(self, values: Sequence[RtdeValue]) -> RtdePacket:
        """Return the data packet of the values."""
        flat: list[float] = [self.recipe]
        for value in values:
            if isinstance(value, tuple):
                flat.extend(value)
            else:
                flat.append(value)
        try:
            return RtdePacket(RtdePacketType.DATA, self._struct.pack(*flat))
        except struct.error as error:
            raise RtdePacketError(f"values do not fit recipe {self.recipe}: {error}") from None

    def unpack(self, payload: bytes) -> list[RtdeValue]:
        """Return the values of the payload of a data packet."""
        if len(payload) != self._struct.size:
            raise RtdePacketError(
                f"data of recipe {self.recipe} have {len(payload)} bytes; the recipe has {self._struct.size}"
            )
        recipe, *flat = self._struct.unpack(payload)
        if recipe != self.recipe:
            raise RtdePacketError(f"data of recipe {recipe} where recipe {self.recipe} is expected")
        values: list[RtdeValue] = []
        start = 0
        for count in self._counts:
            values.append(flat[start] if count == 1 else tuple(flat[start : start + count]))
            start += count
        return values
