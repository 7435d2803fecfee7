"""The guarded move: moves until contact; served under the arm's name."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message, Pose, Vector3, Wrench
from engine.skill import Action
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


class ContactResult(Message, frozen=True, kw_only=True):
    """Whether a contact occurred, and the pose of the tool at rest.

    `wrench` is the external wrench on the tool there, `force_n` its force component against the direction;
    `travelled_m` is the distance travelled along the direction.
    """

    contact: bool
    pose: Pose
    travelled_m: float
    force_n: float
    wrench: Wrench
    duration_s: float


class MoveUntilContact(Action[ContactResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move the tool straight along `direction` until the external force against it reaches `force_n`.

    The arm then decelerates at its limits to rest; the full distance without a contact is a success
    too, with `contact` false. `direction` need not have length 1; it is along the axes of `frame`.
    Rejected before the motion as in CartLinTask.
    """

    direction: Vector3
    distance_m: MaxDistance
    frame: Axes = "world"
    speed_m_s: ApproachSpeed = 0.02
    force_n: ContactForce = 10.0
    collisions: CollisionOptions = CollisionOptions()
