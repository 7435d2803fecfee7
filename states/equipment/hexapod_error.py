"""How far the platform of a hexapod is from a pose, and what a behavior permits."""

from __future__ import annotations

import math
from typing import Annotated

from msgspec import Meta, Struct

from engine.errors import MeasuredValue
from engine.messages import Pose
from engine.messages.pose_algebra import angle_between_rad

HexapodPoseName = Annotated[
    str,
    Meta(
        min_length=1,
        description="Name of one of the poses of its platform",
        extra_json_schema={"cell_name": "hexapod_pose", "of": "device"},
    ),
]
PositionTolerance = Annotated[
    float, Meta(gt=0, description="Permitted distance from the pose", extra_json_schema={"unit": "m"})
]
AngleTolerance = Annotated[
    float, Meta(gt=0, description="Permitted angle from the pose", extra_json_schema={"unit": "rad"})
]


class HexapodError(Struct, frozen=True, kw_only=True):
    """The distance in metres and the angle in radians from a pose."""

    error_m: float
    error_rad: float

    @classmethod
    def between(cls, one: Pose, other: Pose) -> HexapodError:
        """Return the error between two poses of one frame."""
        return cls(error_m=math.dist(one.xyz, other.xyz), error_rad=angle_between_rad(one.xyzw, other.xyzw))

    def within(self, tolerance_m: float, tolerance_rad: float) -> bool:
        """Return whether both are permitted."""
        return self.error_m <= tolerance_m and self.error_rad <= tolerance_rad

    @property
    def words(self) -> str:
        """What people read."""
        return f"{1e3 * self.error_m:.2f} mm and {math.degrees(self.error_rad):.2f}°"

    @property
    def outputs(self) -> dict[str, float]:
        """The outputs of a state that measures it."""
        return {"error_m": self.error_m, "error_rad": self.error_rad}

    def compared(self, tolerance_m: float, tolerance_rad: float) -> tuple[MeasuredValue, ...]:
        """Return both as measured values with their limits."""
        angle, most = math.degrees(self.error_rad), math.degrees(tolerance_rad)
        return (
            MeasuredValue(quantity="distance", measured=1e3 * self.error_m, unit="mm", most=1e3 * tolerance_m),
            MeasuredValue(quantity="angle", measured=angle, unit="°", most=most),
        )
