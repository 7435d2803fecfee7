"""The motion of one arm through a list of waypoints without stopping at them, served under the arm's name."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec

from engine.messages import Message, Pose
from engine.skill import Action, Capability
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import JointMotionResult, PoseMatch, Speed

MOST_WAYPOINTS = 500

BlendDistance = Annotated[
    float,
    msgspec.Meta(
        ge=0.0,
        le=1.0,
        description="Maximum distance of the tool centre point from the waypoint as it passes; 0 stops there",
        extra_json_schema={"unit": "m"},
    ),
]
ToolSpeed = Annotated[
    float,
    msgspec.Meta(gt=0.0, description="Maximum speed of the tool centre point", extra_json_schema={"unit": "m/s"}),
]


class Waypoint(Message, frozen=True, kw_only=True):
    """Either `joints` (radians) or a `pose` of the tool centre point, passed within `blend_m`."""

    joints: tuple[float, ...] = ()
    pose: Pose | None = None
    blend_m: BlendDistance = 0.02


class WaypointsFeedback(Message, frozen=True, kw_only=True):
    """The measured joints, the `progress` in time from 0 to 1, and the index of the `waypoint` that comes next."""

    joints: tuple[float, ...]
    progress: float
    waypoint: int


class WaypointsResult(JointMotionResult, frozen=True, kw_only=True, omit_defaults=True):
    """The end of the motion, the configurations of all `waypoints`, and how many were `passed`."""

    waypoints: tuple[tuple[float, ...], ...] = ()
    passed: int = 0


class FollowWaypoints(Action[WaypointsResult, WaypointsFeedback], frozen=True, kw_only=True):
    """Move through waypoints along straight lines in joint space, whose corners are blended, as one motion.

    The arm stops at waypoints with `blend_m` 0, where the path turns back, and at the last one. A pose becomes the
    configuration nearest to the previous waypoint. Rejected before the motion, with the index of the waypoint and
    the reason, when one is out of reach or needs another configuration of the arm.
    """

    capability: ClassVar[Capability] = "trajectory"

    waypoints: Annotated[tuple[Waypoint, ...], msgspec.Meta(min_length=1, max_length=MOST_WAYPOINTS)]
    speed: Speed = 0.5
    speed_m_s: ToolSpeed | None = None
    match: PoseMatch = "pose"
    collisions: CollisionOptions = CollisionOptions()
