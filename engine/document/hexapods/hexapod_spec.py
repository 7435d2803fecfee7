"""Hexapods: passive Stewart platforms of a cell, whose six legs are held by brakes and which an arm moves.

Nothing drives a leg and nothing measures it. Lengths are in metres, angles in radians, forces in newton.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated

from msgspec import Meta
from msgspec.structs import replace

from engine.document.placement import Length, Name, Placement
from engine.document.text.decoding import StrictModel
from engine.messages import Pose, Vector3

LEGS = 6
_THIRD_RAD = 2.0 * math.pi / 3.0


class JointPattern(StrictModel, frozen=True, kw_only=True):
    """Six joints of legs on a circle, in three pairs: those of the base at 0°, 120° and 240°, of the platform between.

    `spread_rad` is the angle between the two of a pair, `z_m` the height of all in the frame of the plate.
    """

    radius_m: Length
    spread_rad: Annotated[float, Meta(ge=0.0, lt=_THIRD_RAD, description="Angle between the two joints of a pair")]
    z_m: Annotated[float, Meta(description="Height of the joints in the frame of the plate, in metres")] = 0.0


SixPoints = Annotated[
    tuple[Vector3, ...], Meta(min_length=LEGS, max_length=LEGS, description="The joint of each leg, in metres")
]


class HexapodSpec(StrictModel, frozen=True, kw_only=True):
    """A passive platform on six legs with brakes, which a tool grips and moves while the brakes are released.

    `base` and `platform` are fixtures; `carries` are the fixtures that are fixed on the platform, or that axes move on
    it. With the output `brakes` on, the legs are released. A released leg resists with `friction_n`, which carries the
    platform, and with `damping_ns_m`; a braked one slips at `holding_n`. `poses` are those of the platform in the frame
    of the base. `grip` is the frame at which a tool takes the platform.
    """

    base: Annotated[str, Meta(min_length=1, description="The fixture that stands")]
    platform: Annotated[str, Meta(min_length=1, description="The fixture that moves, a box or a cylinder")]
    carries: Annotated[tuple[str, ...], Meta(description="All fixtures that stand on the platform")] = ()
    base_joints: Annotated[JointPattern | SixPoints, Meta(description="The joints in the frame of the base")]
    platform_joints: Annotated[JointPattern | SixPoints, Meta(description="The joints in the frame of the platform")]
    length_m: Annotated[tuple[Length, Length], Meta(description="The shortest and the longest leg")]
    lean_rad: Annotated[
        float, Meta(gt=0.0, le=math.pi / 2, description="Maximum angle between a leg and the normal of either plate")
    ] = math.pi / 2
    mass_kg: Annotated[float, Meta(gt=0.0, description="Mass of the platform with what is fixed on it")] = 1.0
    friction_n: Annotated[float, Meta(gt=0.0, description="Friction of a released leg")] = 5.0
    damping_ns_m: Annotated[float, Meta(gt=0.0, description="Damping of a leg: oil through the open brake")] = 200.0
    holding_n: Annotated[float, Meta(gt=0.0, le=1e5, description="Force along a braked leg at which it slips")] = 400.0
    brakes: Annotated[Name, Meta(description="The output that releases the brakes")]
    released: Annotated[Name, Meta(description="The position of the device with released brakes")] = "released"
    locked: Annotated[Name, Meta(description="The position with locked brakes")] = "locked"
    grip: Annotated[str, Meta(min_length=1, description="The frame at which the tool centre point takes the platform")]
    poses: Annotated[dict[Name, Placement], Meta(description="Poses of the platform in the frame of the base")] = {}

    @property
    def bodies(self) -> tuple[str, ...]:
        """The fixtures that move with the platform: itself, then what it carries."""
        return (self.platform, *self.carries)

    def joints_of_base(self) -> tuple[Vector3, ...]:
        """Return the joints of the six legs in the frame of the base."""
        return _points(self.base_joints, turned_rad=0.0)

    def joints_of_platform(self) -> tuple[Vector3, ...]:
        """Return the joints of the six legs in the frame of the platform, those of each leg in the same order."""
        return _points(self.platform_joints, turned_rad=_THIRD_RAD / 2.0)

    def pose(self, name: str) -> Pose:
        """Return a named pose of the platform in the frame of the base."""
        return self.poses[name].pose()


def placed_hexapod(hexapod: HexapodSpec, named: Callable[[str], str]) -> HexapodSpec:
    """Return a hexapod whose fixtures and grip have their names in the cell."""
    return replace(
        hexapod,
        base=named(hexapod.base),
        platform=named(hexapod.platform),
        carries=tuple(named(one) for one in hexapod.carries),
        grip=named(hexapod.grip),
    )


def _points(joints: JointPattern | tuple[Vector3, ...], *, turned_rad: float) -> tuple[Vector3, ...]:
    """Return the joints of the legs; a leg goes from its pair of the base to the nearest one of the platform."""
    if not isinstance(joints, JointPattern):
        return joints
    half = joints.spread_rad / 2.0
    points: list[Vector3] = []
    for leg in range(LEGS):
        side = -1.0 if leg % 2 == 0 else 1.0
        # With the pair of the base the leg is outside of it by half its spread, with that of the platform inside.
        angle = leg // 2 * _THIRD_RAD + side * (half if not turned_rad else turned_rad - half)
        points.append((joints.radius_m * math.cos(angle), joints.radius_m * math.sin(angle), joints.z_m))
    return tuple(points)
