"""Direct joint control: the sender's own set points, for who designs a controller of his own (RCL 4.3.8, table 9)."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message
from engine.skill import Service
from engine.skills.switch_result import SwitchResult


class JointCommand(Message, frozen=True, kw_only=True):
    """Where the joints shall go, radians in the arm's order; on `<arm>/direct_joints` while direct control is on."""

    position_rad: tuple[float, ...]


class SwitchDirectControl(Service[SwitchResult], frozen=True, kw_only=True):
    """Turn direct joint control on or off; while it is on, the arm rejects every other goal.

    It is not turned on while the arm does anything else. The set points are followed within the limits
    of position, speed, acceleration and jerk; after `watchdog_s` without one the arm comes to rest and
    waits. It ends when it is turned off, when the run that holds the arm ends, and when the arm is stopped.
    """

    on: bool
    watchdog_s: Annotated[float, msgspec.Meta(gt=0.0, le=2.0, description="Longest silence in seconds")] = 0.1
