"""Direct joint control: set points of the sender, for user-defined controllers (RCL 4.3.8, table 9)."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec

from engine.messages import Message
from engine.skill import Capability, Service
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.switch_result import SwitchResult


class JointCommand(Message, frozen=True, kw_only=True):
    """Set points of the joints, radians in the arm's order; on `<arm>/direct_joints` while direct control is on."""

    position_rad: tuple[float, ...]


class SwitchDirectControl(Service[SwitchResult], frozen=True, kw_only=True):
    """Turn direct joint control on or off; while it is on, the arm rejects every other goal.

    It cannot be turned on during another activity of the arm. The arm tracks the set points within its limits
    of position, speed, acceleration and jerk; after `watchdog_s` without a set point it comes to rest and
    waits. Direct control ends when it is turned off, the run that holds the arm ends, or the arm is stopped, and
    before a contact: the path that the arm takes until it has come to rest is checked 30 times a second, and the
    `error` in the status of the arm names both bodies. No contact is meant but those in `collisions.may_touch`.
    """

    capability: ClassVar[Capability] = "stream"

    on: bool
    watchdog_s: Annotated[
        float, msgspec.Meta(gt=0.0, le=2.0, description="Maximum time between set points in seconds")
    ] = 0.1
    collisions: PathCollisions = CollisionOptions()
