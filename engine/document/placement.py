"""Common types of cell documents: names, lengths, colors and placements."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Self

from msgspec import Meta

from engine.document.text.decoding import StrictModel
from engine.messages import Pose, Quaternion, Vector3
from engine.messages.pose_algebra import compose_poses

_METRES, _RADIANS = {"unit": "m"}, {"unit": "rad"}

# Sine of the pitch beyond which roll and yaw turn about the same axis.
_UPRIGHT = 1.0 - 1e-9

Length = Annotated[float, Meta(gt=0.0, description="A length in metres, above 0", extra_json_schema=_METRES)]
Angle = Annotated[float, Meta(ge=0.0, description="An angle in radians, 0 or more", extra_json_schema=_RADIANS)]
Name = Annotated[str, Meta(pattern="^[a-z][a-z0-9_]{0,63}$", description="Lower-case letters, digits and `_`")]
Color = Annotated[str, Meta(pattern="^#[0-9a-fA-F]{6}$", description="A color as `#rrggbb`")]
Offset = Annotated[float, Meta(ge=0.0, description="A distance in metres, 0 or more", extra_json_schema=_METRES)]
PositionXyz = Annotated[Vector3, Meta(description="A point in metres", extra_json_schema=_METRES)]
FrameName = Annotated[
    str, Meta(min_length=1, description="What it is relative to: `world`, a named frame, or a fixture")
]
RotationRpy = Annotated[Vector3, Meta(description="Angles in radians, about x, y, z", extra_json_schema=_RADIANS)]


class Placement(StrictModel, frozen=True, kw_only=True):
    """A pose in the world, for a frame in its parent: position, and rotation about the fixed axes x, y, z in turn."""

    xyz: PositionXyz = (0.0, 0.0, 0.0)
    rpy: RotationRpy = (0.0, 0.0, 0.0)

    @classmethod
    def of(cls, pose: Pose) -> Self:
        """Return the placement of a pose, without its frame."""
        return cls(xyz=pose.xyz, rpy=_roll_pitch_yaw(pose.xyzw))

    def pose(self) -> Pose:
        """Return the placement as a pose in the frame `world`, or in the parent of a frame."""
        return Pose(xyz=self.xyz, xyzw=_quaternion(self.rpy))


class FramedPlacement(Placement, frozen=True, kw_only=True):
    """A pose in a frame of the cell; in a `Cell` that was loaded, it is in the world."""

    frame: FrameName = "world"

    def in_world(self, frames: Mapping[str, Pose]) -> FramedPlacement:
        """Return the same place in the world; `frames` are the poses of all frames in the world."""
        if self.frame == "world":
            return self
        return FramedPlacement.of(compose_poses(frames[self.frame], self.pose()))


def point_in_world(frame: Pose, point: Vector3) -> Vector3:
    """Return where a point of a frame is, whose pose in the world is given."""
    return compose_poses(frame, Pose(xyz=point)).xyz


def _roll_pitch_yaw(xyzw: Quaternion) -> Vector3:
    """Return the angles about the fixed axes x, y, z; where y is turned by 90°, x is not turned at all."""
    x, y, z, w = xyzw
    sine = max(-1.0, min(1.0, 2.0 * (w * y - z * x)))
    if abs(sine) > _UPRIGHT:
        return 0.0, math.copysign(math.pi / 2.0, sine), math.copysign(2.0, -sine) * math.atan2(x, w)
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    return roll, math.asin(sine), math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def _quaternion(rpy: Vector3) -> Quaternion:
    (cr, cp, cy), (sr, sp, sy) = (tuple(f(angle / 2) for angle in rpy) for f in (math.cos, math.sin))
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
