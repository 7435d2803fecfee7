"""One side of a protocol that is fed with packets."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Direction = Literal["to the device", "to the driver"]


@dataclass(frozen=True)
class FuzzTarget:
    """What is fed, and what it must not do.

    Attributes:
        protocol: What is spoken.
        direction: Who is fed.
        valid: Valid packets, from which others are made.
        feed: Feeds one packet; returns why it was refused, `ignored` for silence, empty where it was taken. Whatever
            it raises is a crash.
        has_moved: Whether the device has moved, or has switched, without a command that permits it.
        share: Share of all packets that it gets; slow ones get fewer.
    """

    protocol: str
    direction: Direction
    valid: tuple[bytes, ...]
    feed: Callable[[bytes], str]
    has_moved: Callable[[], bool]
    share: float = 1.0
