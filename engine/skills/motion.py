"""Motion skills of one arm, served under the arm's name (RCL 4.3, RCY 4.3).

Goals are sent to `<arm>/<skill_name>`. Every action returns its final configuration or pose, also when
it was preempted or failed during the motion; afterwards the arm is at rest and ready for the next goal.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import msgspec

from engine.messages import Message, Pose
from engine.skill import Action, Capability, Service
from engine.skills.collision_options import CollisionOptions

Speed = Annotated[float, msgspec.Meta(gt=0.0, le=1.0, description="Fraction of the joint speed limits")]
PoseMatch = Annotated[
    Literal["pose", "position", "axis"],
    msgspec.Meta(description="Constrained part of the pose: all, the position, or position and direction of z"),
]
"""`pose` needs an arm of six joints, `axis` (z of the tool) five, `position` two or three; the rest is free."""


class JointMotionFeedback(Message, frozen=True, kw_only=True):
    """The present configuration, and `progress` from 0 to 1 along the path."""

    joints: tuple[float, ...]
    progress: float


class JointMotionResult(Message, frozen=True, kw_only=True, omit_defaults=True):
    """The measured configuration at the end, radians, and the configuration `start` of the motion.

    `deviation_rad` is how far the joint that is farthest from its set point is there.
    """

    joints: tuple[float, ...]
    duration_s: float
    start: tuple[float, ...] = ()
    deviation_rad: float = 0.0


class CartMotionFeedback(Message, frozen=True, kw_only=True):
    """The measured pose of the tool centre point, and `progress` from 0 to 1 along the path."""

    pose: Pose
    progress: float


class CartMotionResult(Message, frozen=True, kw_only=True, omit_defaults=True):
    """The measured pose of the tool centre point at the end, and the configuration `start` of the motion.

    `deviation_rad` is how far the joint that is farthest from its set point is there.
    """

    pose: Pose
    duration_s: float
    start: tuple[float, ...] = ()
    deviation_rad: float = 0.0


class JointTrapVel(Action[JointMotionResult, JointMotionFeedback], frozen=True, kw_only=True):
    """Move in joint space, all joints in phase, with a trapezoidal velocity profile (RCL table 3)."""

    capability: ClassVar[Capability] = "trajectory"

    joints: tuple[float, ...]
    speed: Speed
    collisions: CollisionOptions = CollisionOptions()


class CartTrapVel(Action[CartMotionResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move to a pose of the tool centre point by a joint-space trapezoidal profile (RCL table 4).

    The goal configuration is the inverse-kinematics solution nearest to the current one. An arm with
    fewer than six joints reaches few full poses: use a `match` of `position` or `axis`.
    """

    capability: ClassVar[Capability] = "trajectory"

    pose: Pose
    speed: Speed
    match: PoseMatch = "pose"
    collisions: CollisionOptions = CollisionOptions()


class CartLinTask(Action[CartMotionResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move the tool centre point on a straight line, minimum jerk in position and SLERP (RCL table 5).

    Rejected before the motion, with the reason, when a joint limit or joint speed would be exceeded
    or the line cannot be followed.
    """

    capability: ClassVar[Capability] = "trajectory"

    pose: Pose
    duration_s: Annotated[float, msgspec.Meta(gt=0.0, description="Travel time in seconds")]
    collisions: CollisionOptions = CollisionOptions()


class ForwardKinematics(Service[Pose], frozen=True, kw_only=True):
    """Return the pose of the tool centre point for `joints`, or for the measured configuration when empty."""

    joints: tuple[float, ...] = ()


class InverseKinematicsResult(Message, frozen=True, kw_only=True):
    """A configuration for a pose, radians, with measures of manipulability.

    `dexterity` is the smallest singular value of the Jacobian, metres and radians weighted equally;
    `manipulability` is the product of all singular values. When `singular`, `remark` names the
    singularity and the restricted motion of the tool.
    """

    joints: tuple[float, ...]
    dexterity: float
    manipulability: float
    singular: bool
    remark: str = ""


class ConfigurationQuery(msgspec.Struct, frozen=True, kw_only=True):
    """A pose of the tool centre point; an empty `seed` stands for the measured configuration."""

    pose: Pose
    seed: tuple[float, ...] = ()
    match: PoseMatch = "pose"


class InverseKinematics(ConfigurationQuery, Service[InverseKinematicsResult], frozen=True, kw_only=True):
    """Return the configuration for a pose of the tool centre point that is reached fastest from `seed`.

    Fails, with the reason, when the arm cannot reach the pose, or the part of it that `match` selects, within its
    joint limits.
    """


class InverseKinematicsSolutions(Message, frozen=True, kw_only=True):
    """Configurations for a pose, radians, sorted by the time to reach them from the seed.

    `complete` is true when these are all solutions; for a redundant arm they are a sample. `how`
    describes the solution method.
    """

    solutions: tuple[tuple[float, ...], ...]
    complete: bool
    how: str


class AllInverseKinematics(ConfigurationQuery, Service[InverseKinematicsSolutions], frozen=True, kw_only=True):
    """Return the configurations for a pose of the tool centre point, including all turns within the joint limits.

    Sorted by the time to reach them from `seed`. Fails as `InverseKinematics` does.
    """
