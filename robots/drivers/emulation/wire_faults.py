"""Faults of the wire between an emulator and its clients, switched on its side channel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field


@dataclass
class WireFaults:
    """What goes wrong at present.

    `cut`: no connection and no byte. `frozen`: bytes arrive and nothing is answered. `slow_s`: each answer is late.
    `garbage`: each answer has other bytes. `refuse`: each request is answered with an error of the protocol.
    """

    cut: bool = False
    frozen: bool = False
    slow_s: float = 0.0
    garbage: bool = False
    refuse: bool = False
    late_until_s: dict[Callable[[bytes], object], float] = field(default_factory=dict[Callable[[bytes], object], float])
    """When the last late answer of each connection is sent, on the event loop's clock: bytes of one do not overtake
    one another."""


def spoil(reply: bytes) -> bytes:
    """Return bytes of the same length that are no answer, the same for the same reply."""
    return bytes((byte * 31 + 97 + 7 * index) & 0xFF for index, byte in enumerate(reply))
