"""The small types that Foxglove's schemas share."""

from __future__ import annotations

import msgspec


class Time(msgspec.Struct, frozen=True):
    """An instant, or a duration."""

    sec: int
    nsec: int


class Vector3(msgspec.Struct, frozen=True):
    """Metres, or factors."""

    x: float
    y: float
    z: float


class Quaternion(msgspec.Struct, frozen=True):
    """A unit quaternion."""

    x: float
    y: float
    z: float
    w: float


class Pose(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.Pose`."""

    position: Vector3
    orientation: Quaternion


class Color(msgspec.Struct, frozen=True):
    """Parts from 0 to 1."""

    r: float
    g: float
    b: float
    a: float


def time_of(at_ns: int) -> Time:
    """Return nanoseconds as seconds and the rest."""
    return Time(at_ns // 1_000_000_000, at_ns % 1_000_000_000)
