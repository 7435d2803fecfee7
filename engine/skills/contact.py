"""The guarded move: moves until contact; served under the arm's name."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message, Pose, Vector3, Wrench
from engine.skill import Action
from engine.skills.axes import Axes
from engine.skills.motion import CartMotionFeedback

MaxDistance = Annotated[float, msgspec.Meta(gt=0.0, description="Longest way", extra_json_schema={"unit": "m"})]
ApproachSpeed = Annotated[
    float, msgspec.Meta(gt=0.0, le=0.25, description="Greatest speed on the way", extra_json_schema={"unit": "m/s"})
]
ContactForce = Annotated[
    float, msgspec.Meta(gt=0.0, description="Force that counts as a contact", extra_json_schema={"unit": "N"})
]


class ContactResult(Message, frozen=True, kw_only=True):
    """Whether something was touched, and where the tool came to rest.

    `wrench` is what the environment does to the tool there, `force_n` its share against the way;
    `travelled_m` is the way made along the direction.
    """

    contact: bool
    pose: Pose
    travelled_m: float
    force_n: float
    wrench: Wrench
    duration_s: float


class MoveUntilContact(Action[ContactResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move the tool straight along `direction` until the environment pushes back with `force_n`.

    The arm then brakes as hard as it may and rests; the whole way without a contact is a success
    too, with `contact` false. `direction` needs no length of 1; it is along the axes of `frame`.
    Rejected beforehand like CartLinTask.
    """

    direction: Vector3
    distance_m: MaxDistance
    frame: Axes = "world"
    speed_m_s: ApproachSpeed = 0.02
    force_n: ContactForce = 10.0
