"""How a part is turned: its tilt, and its deviation from an expected orientation."""

from __future__ import annotations

import math
from typing import Annotated

import msgspec
from msgspec import Meta

from engine.errors import Cause, MeasuredValue
from engine.messages import Quaternion, Vector3
from engine.messages.pose_algebra import angle_between_rad, compose_rotations, rotate_vector

_RADIANS = {"unit": "rad"}
_WORLD_UP: Vector3 = (0.0, 0.0, 1.0)
_LEAST_NORM = 1e-6

Angle = Annotated[float, Meta(gt=0, le=3.15, extra_json_schema=_RADIANS)]
AxisOfPart = Annotated[Vector3, Meta(description="Axis in the frame of the part, of any length")]


class ExpectedOrientation(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An orientation of the part in the world, or in the given frame of the cell.

    A part that looks the same however it is turned about an axis has that `symmetry_axis`, in its own frame; one
    that looks the same after each of some equal turns about it, such as a square one, has this number of `turns`.
    """

    xyzw: Annotated[Quaternion, Meta(description="Unit quaternion x y z w")] = (0.0, 0.0, 0.0, 1.0)
    tolerance_rad: Angle = 0.17
    symmetry_axis: AxisOfPart | None = None
    turns: Annotated[int, Meta(ge=0, le=360, description="Equal turns about `symmetry_axis`; 0 for any angle")] = 0

    def __post_init__(self) -> None:
        if abs(math.hypot(*self.xyzw) - 1.0) > 1e-3:
            raise ValueError("`xyzw` must be a unit quaternion")
        if self.symmetry_axis is not None and math.hypot(*self.symmetry_axis) < _LEAST_NORM:
            raise ValueError("`symmetry_axis` must not be a zero vector")
        if self.turns and self.symmetry_axis is None:
            raise ValueError("`turns` are about a `symmetry_axis`: give it too")

    def deviation_rad(self, measured: Quaternion, expected: Quaternion) -> float:
        """Return the smallest angle from the expected to the measured orientation, with the symmetry of the part."""
        if self.symmetry_axis is None:
            return angle_between_rad(measured, expected)
        if not self.turns:
            return _angle_rad(rotate_vector(measured, self.symmetry_axis), rotate_vector(expected, self.symmetry_axis))
        turned = (_turn(self.symmetry_axis, 2 * math.pi * turn / self.turns) for turn in range(self.turns))
        return min(angle_between_rad(measured, compose_rotations(expected, turn)) for turn in turned)


def tilt_fault(up: Vector3, measured: Quaternion, *, most_rad: float, where: str) -> Cause | None:
    """Return the cause that a part has toppled; None if its axis `up` points up within `most_rad`."""
    tilt_rad = _angle_rad(rotate_vector(measured, up), _WORLD_UP)
    if tilt_rad <= most_rad:
        return None
    message = f"it is tilted by {_degrees(tilt_rad)}, {_degrees(most_rad)} allowed"
    return _fault(message, "tilt", tilt_rad, most_rad, where)


def orientation_fault(
    expected: ExpectedOrientation, measured: Quaternion, within: Quaternion, *, where: str
) -> Cause | None:
    """Return the cause that a part is turned otherwise than expected in a frame, whose orientation is `within`."""
    off_rad = expected.deviation_rad(measured, compose_rotations(within, expected.xyzw))
    if off_rad <= expected.tolerance_rad:
        return None
    message = f"it is turned by {_degrees(off_rad)} from its orientation, {_degrees(expected.tolerance_rad)} allowed"
    return _fault(message, "deviation from the orientation", off_rad, expected.tolerance_rad, where)


def _fault(message: str, quantity: str, measured_rad: float, most_rad: float, where: str) -> Cause:
    measured, most = math.degrees(measured_rad), math.degrees(most_rad)
    compared = MeasuredValue(quantity=quantity, measured=measured, unit="deg", most=most)
    return Cause(message=message, where=where, compared=(compared,))


def _degrees(angle_rad: float) -> str:
    return f"{math.degrees(angle_rad):.1f} deg"


def _angle_rad(one: Vector3, other: Vector3) -> float:
    """Return the angle between two directions, exact also near 0 and pi."""
    a, b = _unit(one), _unit(other)
    apart = math.hypot(*(x - y for x, y in zip(a, b, strict=True)))
    along = math.hypot(*(x + y for x, y in zip(a, b, strict=True)))
    return 2 * math.atan2(apart, along)


def _unit(vector: Vector3) -> Vector3:
    length = math.hypot(*vector)
    x, y, z = (value / length for value in vector)
    return (x, y, z)


def _turn(axis: Vector3, angle_rad: float) -> Quaternion:
    x, y, z = (value * math.sin(angle_rad / 2) for value in _unit(axis))
    return (x, y, z, math.cos(angle_rad / 2))
