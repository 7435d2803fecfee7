"""Motion skills of one arm, answered under the arm's name (RCL 4.3, RCY 4.3).

The goal is given to `<arm>/<skill_name>`. Every action returns its final configuration or
pose on success; a preempted or failed goal leaves the arm at rest and ready for the next.
"""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message, Pose
from engine.skill import Action, Service

Speed = Annotated[float, msgspec.Meta(gt=0.0, le=1.0, description="Share of the joint speed limits")]


class JointMotionFeedback(Message, frozen=True, kw_only=True):
    """Where the arm is on its way: `progress` from 0 to 1 along the path."""

    joints: tuple[float, ...]
    progress: float


class JointMotionResult(Message, frozen=True, kw_only=True):
    """The measured configuration at the end, radians."""

    joints: tuple[float, ...]
    duration_s: float


class CartMotionFeedback(Message, frozen=True, kw_only=True):
    """The measured pose of the tool centre point on its way."""

    pose: Pose
    progress: float


class CartMotionResult(Message, frozen=True, kw_only=True):
    """The measured pose of the tool centre point at the end."""

    pose: Pose
    duration_s: float


class JointTrapVel(Action[JointMotionResult, JointMotionFeedback], frozen=True, kw_only=True):
    """Move in joint space, all joints in phase, with a trapezoidal velocity profile (RCL table 3)."""

    joints: tuple[float, ...]
    speed: Speed


class CartTrapVel(Action[CartMotionResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move to a pose of the tool centre point by a joint-space trapezoidal profile (RCL table 4).

    The goal configuration is the inverse-kinematics solution nearest to the current one.
    """

    pose: Pose
    speed: Speed


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
