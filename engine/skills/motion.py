"""Motion skills of one arm, answered under the arm's name (RCL 4.3, RCY 4.3).

The goal is given to `<arm>/<skill_name>`. Every action returns its final configuration or
pose, also when it was preempted or failed on the way; it leaves the arm at rest and ready for the next.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages import Message, Pose
from engine.skill import Action, Service

Speed = Annotated[float, msgspec.Meta(gt=0.0, le=1.0, description="Share of the joint speed limits")]
PoseMatch = Annotated[
    Literal["pose", "position", "axis"],
    msgspec.Meta(description="What of the pose counts: all, its position, or position and direction of z"),
]
"""`pose` needs an arm of six joints, `axis` (z of the tool) five, `position` two or three; the rest comes as it may."""


class JointMotionFeedback(Message, frozen=True, kw_only=True):
    """Where the arm is on its way: `progress` from 0 to 1 along the path."""

    joints: tuple[float, ...]
    progress: float


class JointMotionResult(Message, frozen=True, kw_only=True, omit_defaults=True):
    """The measured configuration at the end, radians, and the configuration `start` that the motion began at."""

    joints: tuple[float, ...]
    duration_s: float
    start: tuple[float, ...] = ()


class CartMotionFeedback(Message, frozen=True, kw_only=True):
    """The measured pose of the tool centre point on its way."""

    pose: Pose
    progress: float


class CartMotionResult(Message, frozen=True, kw_only=True, omit_defaults=True):
    """The measured pose of the tool centre point at the end, and the configuration `start` that the motion began at."""

    pose: Pose
    duration_s: float
    start: tuple[float, ...] = ()


class JointTrapVel(Action[JointMotionResult, JointMotionFeedback], frozen=True, kw_only=True):
    """Move in joint space, all joints in phase, with a trapezoidal velocity profile (RCL table 3)."""

    joints: tuple[float, ...]
    speed: Speed


class CartTrapVel(Action[CartMotionResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move to a pose of the tool centre point by a joint-space trapezoidal profile (RCL table 4).

    The goal configuration is the inverse-kinematics solution nearest to the current one. An arm of
    fewer than six joints reaches hardly any full pose: ask it for a `match` of `position` or `axis`.
    """

    pose: Pose
    speed: Speed
    match: PoseMatch = "pose"


class CartLinTask(Action[CartMotionResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move the tool centre point on a straight line, minimum jerk in position and SLERP (RCL table 5).

    Rejected beforehand, with the reason, where a joint limit or joint speed would be exceeded
    or the line cannot be followed.
    """

    pose: Pose
    duration_s: Annotated[float, msgspec.Meta(gt=0.0, description="Travel time in seconds")]


class ForwardKinematics(Service[Pose], frozen=True, kw_only=True):
    """Return the pose of the tool centre point for `joints`, or for the measured ones when empty."""

    joints: tuple[float, ...] = ()


class InverseKinematicsResult(Message, frozen=True, kw_only=True):
    """A configuration for a pose, radians, and how well the arm can move there.

    `dexterity` is the smallest singular value of the Jacobian, metres and radians weighed alike;
    `manipulability` the product of all of them. Where `singular`, `remark` says in words which
    singularity it is and what the tool can hardly do.
    """

    joints: tuple[float, ...]
    dexterity: float
    manipulability: float
    singular: bool
    remark: str = ""


class InverseKinematics(Service[InverseKinematicsResult], frozen=True, kw_only=True):
    """Return the configuration for a pose of the tool centre point that is soonest reached from `seed`.

    From the measured joints when `seed` is empty. Fails, with the reason, where the arm does not
    reach the pose, or the part of it that `match` names, within its joint limits.
    """

    pose: Pose
    seed: tuple[float, ...] = ()
    match: PoseMatch = "pose"


class InverseKinematicsSolutions(Message, frozen=True, kw_only=True):
    """Configurations for a pose, radians, soonest reached from the seed first.

    `complete` tells whether these are all there are; of a redundant arm they are a sample. `how`
    says in words where they come from.
    """

    solutions: tuple[tuple[float, ...], ...]
    complete: bool
    how: str


class AllInverseKinematics(Service[InverseKinematicsSolutions], frozen=True, kw_only=True):
    """Return the configurations for a pose of the tool centre point, every turn that the limits allow among them.

    Ordered by how soon they are reached from `seed`, the measured joints when it is empty. Fails as
    `InverseKinematics` does.
    """

    pose: Pose
    seed: tuple[float, ...] = ()
    match: PoseMatch = "pose"
