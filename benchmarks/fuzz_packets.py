"""Packets that no device and no driver would send: valid ones with changes, pieces of them, and any bytes; seeded."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence

_NUMBERS = (0, 1, 0x7F, 0x80, 0xFF)


def mutated(chance: random.Random, valid: Sequence[bytes], *, longest: int = 1600) -> bytes:
    """Return a packet: one in eight is valid, one in eight any bytes, the rest valid ones with changes."""
    kind = chance.randrange(8)
    if kind == 0:
        return chance.choice(valid)
    if kind == 1:
        return chance.randbytes(chance.choice((0, 1, 2, 7, 40, 300, longest)))
    packet = bytearray(chance.choice(valid))
    for _ in range(chance.choice((1, 1, 1, 2, 4))):
        _CHANGES[chance.randrange(len(_CHANGES))](chance, packet, valid)
    return bytes(packet[:longest])


def _flip_bit(chance: random.Random, packet: bytearray, _valid: Sequence[bytes]) -> None:
    if packet:
        packet[chance.randrange(len(packet))] ^= 1 << chance.randrange(8)


def _set_byte(chance: random.Random, packet: bytearray, _valid: Sequence[bytes]) -> None:
    if packet:
        packet[chance.randrange(len(packet))] = chance.choice((*_NUMBERS, chance.randrange(256)))


def _set_extreme(chance: random.Random, packet: bytearray, _valid: Sequence[bytes]) -> None:
    """Make a word, a float or a double in it the smallest, the largest, infinite, or no number."""
    size = chance.choice((2, 4, 8))
    if len(packet) >= size:
        at = chance.randrange(len(packet) - size + 1)
        packet[at : at + size] = chance.choice(_EXTREMES[size])


def _cut(chance: random.Random, packet: bytearray, _valid: Sequence[bytes]) -> None:
    del packet[chance.randrange(len(packet) + 1) :]


def _insert(chance: random.Random, packet: bytearray, _valid: Sequence[bytes]) -> None:
    at = chance.randrange(len(packet) + 1)
    packet[at:at] = chance.randbytes(chance.choice((1, 2, 30)))


def _remove(chance: random.Random, packet: bytearray, _valid: Sequence[bytes]) -> None:
    at = chance.randrange(len(packet) + 1)
    del packet[at : at + chance.choice((1, 2, 8))]


def _append(chance: random.Random, packet: bytearray, valid: Sequence[bytes]) -> None:
    packet += chance.choice(valid)


def _repeat(chance: random.Random, packet: bytearray, _valid: Sequence[bytes]) -> None:
    packet += packet[: chance.randrange(len(packet) + 1)]


_CHANGES: tuple[Callable[[random.Random, bytearray, Sequence[bytes]], None], ...] = (
    _flip_bit,
    _set_byte,
    _set_extreme,
    _cut,
    _insert,
    _remove,
    _append,
    _repeat,
)
_FLOATS = ("7f800000", "ff800000", "7fc00000", "7f7fffff", "00000001")
_DOUBLES = ("7ff0000000000000", "fff0000000000000", "7ff8000000000000", "7fefffffffffffff", "0000000000000001")
_EXTREMES = {
    2: [bytes.fromhex(text) for text in ("0000", "ffff", "7fff", "8000", "0100")],
    4: [each[::step] for each in map(bytes.fromhex, (*_FLOATS, "ffffffff", "80000000")) for step in (1, -1)],
    8: [each[::step] for each in map(bytes.fromhex, (*_DOUBLES, "ffffffffffffffff")) for step in (1, -1)],
}
