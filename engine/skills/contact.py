"""The guarded move: moves until contact; served under the arm's name."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec

from engine.messages import Message, Pose, Vector3, Wrench
from engine.skill import Action, Capability
from engine.skills.axes import Axes
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import CartMotionFeedback

MaxDistance = Annotated[float, msgspec.Meta(gt=0.0, description="Maximum distance", extra_json_schema={"unit": "m"})]
ApproachSpeed = Annotated[
    float, msgspec.Meta(gt=0.0, le=0.25, description="Maximum speed on the path", extra_json_schema={"unit": "m/s"})
]
ContactForce = Annotated[
    float,
    msgspec.Meta(
        gt=0.0,
        description="Force that counts as a contact",
        extra_json_schema={"unit": "N", "measured_on": "wrench"},
    ),
]
PeakForce = Annotated[
    float,
    msgspec.Meta(
        gt=0.0,
        description="Maximum force at the first touch; it lowers the speed after `clear_m`",
        extra_json_schema={"unit": "N"},
    ),
]
ClearDistance = Annotated[
    float,
    msgspec.Meta(
        ge=0.0,
        description="With `peak_n`: distance without anything to touch, at `speed_m_s`",
        extra_json_schema={"unit": "m"},
    ),
]
SurfaceStiffness = Annotated[
    float,
    msgspec.Meta(
        gt=0.0,
        description="With `peak_n`: stiffness of surface and tool together, by default of rubber pads on metal",
        extra_json_schema={"unit": "N/m"},
    ),
]
RIGID_N_M = 1.3e6
"""Stiffness of rubber pads flat on something rigid, from peaks of simulated arms; on an edge it is a third of it."""


class ContactResult(Message, frozen=True, kw_only=True):
    """Whether a contact occurred, and the pose of the tool at rest.

    `wrench` is the external wrench on the tool there, `force_n` its force component against the direction;
    `peak_n` is the greatest that was measured on the path, and `travelled_m` the distance along the direction.
    """

    contact: bool
    pose: Pose
    travelled_m: float
    force_n: float
    wrench: Wrench
    duration_s: float
    peak_n: float = 0.0


class MoveUntilContact(Action[ContactResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move the tool straight along `direction` until the external force against it reaches `force_n`.

    The arm then decelerates at its limits to rest; the full distance without a contact is a success
    too, with `contact` false. `direction` need not have length 1; it is along the axes of `frame`.
    With `peak_n` the tool travels the first `clear_m` at `speed_m_s` and the rest as slowly as this peak requires of
    the mass of arm and load on a contact of `surface_n_m`. Rejected before the motion as in CartLinTask.
    """

    capability: ClassVar[Capability] = "contact"

    direction: Vector3
    distance_m: MaxDistance
    frame: Axes = "world"
    speed_m_s: ApproachSpeed = 0.02
    force_n: ContactForce = 10.0
    peak_n: PeakForce | None = None
    clear_m: ClearDistance = 0.0
    surface_n_m: SurfaceStiffness = RIGID_N_M
    collisions: CollisionOptions = CollisionOptions()
