"""The small types that Foxglove's schemas share."""

from __future__ import annotations

import msgspec


class FoxgloveTime(msgspec.Struct, frozen=True):
    """An instant, or a duration."""

    sec: int
    nsec: int


class FoxgloveVector3(msgspec.Struct, frozen=True):
    """Metres, or factors."""

    x: float
    y: float
    z: float


class FoxgloveQuaternion(msgspec.Struct, frozen=True):
    """A unit quaternion."""

    x: float
    y: float
    z: float
    w: float


class FoxglovePose(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.Pose`."""

    position: FoxgloveVector3
    orientation: FoxgloveQuaternion


class FoxgloveColor(msgspec.Struct, frozen=True):
    """Parts from 0 to 1."""

    r: float
    g: float
    b: float
    a: float


def time_of(at_ns: int) -> FoxgloveTime:
    """Return nanoseconds as seconds and the rest."""
    return FoxgloveTime(at_ns // 1_000_000_000, at_ns % 1_000_000_000)
