"""Common types of cell documents: names, lengths, colors and placements."""

from __future__ import annotations

import math
from typing import Annotated

from msgspec import Meta

from engine.document.text.decoding import StrictModel
from engine.messages import Pose, Quaternion, Vector3

_METRES, _RADIANS = {"unit": "m"}, {"unit": "rad"}

Length = Annotated[float, Meta(gt=0.0, description="A length in metres, above 0", extra_json_schema=_METRES)]
Angle = Annotated[float, Meta(ge=0.0, description="An angle in radians, 0 or more", extra_json_schema=_RADIANS)]
Name = Annotated[str, Meta(pattern="^[a-z][a-z0-9_]{0,63}$", description="Lower-case letters, digits and `_`")]
Color = Annotated[str, Meta(pattern="^#[0-9a-fA-F]{6}$", description="A color as `#rrggbb`")]
Offset = Annotated[float, Meta(ge=0.0, description="A distance in metres, 0 or more", extra_json_schema=_METRES)]
PositionXyz = Annotated[Vector3, Meta(description="A point in metres", extra_json_schema=_METRES)]
RotationRpy = Annotated[Vector3, Meta(description="Angles in radians, about x, y, z", extra_json_schema=_RADIANS)]


class Placement(StrictModel, frozen=True, kw_only=True):
    """A pose in the world, for a frame in its parent: position, and rotation about the fixed axes x, y, z in turn."""

    xyz: PositionXyz = (0.0, 0.0, 0.0)
    rpy: RotationRpy = (0.0, 0.0, 0.0)

    def pose(self) -> Pose:
        """Return the placement as a pose in the frame `world`, or in the parent of a frame."""
        return Pose(xyz=self.xyz, xyzw=_quaternion(self.rpy))


def _quaternion(rpy: Vector3) -> Quaternion:
    (cr, cp, cy), (sr, sp, sy) = (tuple(f(angle / 2) for angle in rpy) for f in (math.cos, math.sin))
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
