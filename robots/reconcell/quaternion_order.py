"""The order of quaternions on the wire, which the document leaves open."""

from __future__ import annotations

from typing import Literal

from engine.messages import Quaternion

QuaternionOrder = Literal["xyzw", "wxyz"]


def from_wire(values: tuple[float, ...], order: QuaternionOrder) -> Quaternion:
    """Return the quaternion x y z w of four numbers on the wire."""
    a, b, c, d = values
    return (a, b, c, d) if order == "xyzw" else (b, c, d, a)


def to_wire(xyzw: Quaternion, order: QuaternionOrder) -> Quaternion:
    """Return the four numbers on the wire of a quaternion x y z w."""
    x, y, z, w = xyzw
    return (x, y, z, w) if order == "xyzw" else (w, x, y, z)
