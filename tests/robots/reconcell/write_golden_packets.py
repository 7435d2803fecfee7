"""Writes `golden_packets.txt`: one packet for each layout of the appendix, made with `struct` only.

The numbers are typed from the appendix and not taken from the table of the code. Run: python -m
tests.robots.reconcell.write_golden_packets
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from pathlib import Path

FILE = Path(__file__).with_name("golden_packets.txt")
UNIT = (0.5, -0.5, 0.5, 0.5)
DMPS = ((25000, 7), (25100, 6))


def ramp(count: int, start: float) -> Iterator[float]:
    """Return numbers of which none is like another."""
    return (start + 0.125 * index for index in range(count))


def doubles(*values: float) -> bytes:
    """Return doubles, the lowest byte first."""
    return b"".join(struct.pack("<d", value) for value in values)


def golden() -> Iterable[tuple[str, int, bytes]]:
    """Yield direction, port and bytes."""
    for mode in (4, 5, 11, 12, 13, 16, 101):
        yield ">", 10000, bytes([mode])
    yield ">", 11000, doubles(517.0)
    yield ">", 12000, doubles(0.1, 0.2, 0.3, *UNIT, 0.01, 0.02, 0.03, 1.5, 1.0, 2.0, 3.0, 0.1, 0.2, 0.3)
    yield ">", 20000, doubles(*ramp(6, -0.5))
    for base, components in DMPS:
        goal, start = (
            (*ramp(components - 4, 0.25), *UNIT) if components == 7 else tuple(ramp(6, 0.25)),
            (*ramp(components - 4, 0.5), *UNIT) if components == 7 else tuple(ramp(6, 0.5)),
        )
        yield ">", base, doubles(184.0, 48.0, 2.0, 3.0, *goal, *start, *ramp(6, 0.0))
        for row in range(8):
            yield ">", base + 1 + row, doubles(*ramp(184, row + 1.0))
        yield ">", base + 9, doubles(1.0, 0.0)
        yield ">", base + 9, bytes([0, 1])
        yield ">", base + 10, bytes([1])
        yield ">", base + 10, doubles(1.0)
    yield ">", 26000, doubles(*ramp(6, -0.5), 0.75)
    yield ">", 27000, doubles(0.4, -0.2, 0.6, *UNIT, 2.5)
    yield ">", 27000, doubles(*ramp(100, 0.0))
    yield ">", 27000, doubles(*ramp(184, 0.0))
    for row in range(8):
        yield ">", 27001 + row, doubles(*ramp(184, row + 0.0625))
    for row in range(8):
        yield ">", 28000 + row, doubles(*ramp(184, row + 0.03125))
    yield "<", 15000, doubles(*ramp(45, -2.0))
    yield "<", 15001, bytes([12, 11, 1, 0, 1, 0, 1])
    yield "<", 15002, bytes([1])
    yield "<", 15003, bytes([1, 0])
    yield "<", 15004, bytes([0, 1])
    yield "<", 15005, doubles(1.0, 3.0, 1.0, 0.0, 0.25, 0.0)
    yield "<", 15006, doubles(0.0, 4.0, 0.0, 1.0, 1.0, 1.0)


if __name__ == "__main__":
    lines = [
        "# Packets by direction (> to the server, < from it) and port, in hexadecimal, as the appendices print them."
    ]
    lines += [f"{direction} {port} {data.hex()}" for direction, port, data in golden()]
    FILE.write_text("\n".join(lines) + "\n", encoding="ascii")
