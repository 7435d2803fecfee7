"""Moving an arm by hand from a panel: as long as told, or step by step; answered under the arm's name.

Hold-to-run: send JogJoints or JogTool without a velocity and publish `JogCommand`s on `<arm>/jog` while
the key is down. When they stay away for `watchdog_s` the arm comes to rest, and after `idle_s` the
goal ends as succeeded. Cancel it to end at once.
"""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message, Pose, Vector3
from engine.skill import Action
from engine.skills.axes import Axes
from engine.skills.motion import CartMotionFeedback, CartMotionResult, JointMotionFeedback, JointMotionResult, Speed
from engine.skills.planning import Margin

WatchdogTime = Annotated[
    float, msgspec.Meta(gt=0.0, le=2.0, description="Come to rest after so long a silence, in seconds")
]
IdleTimeout = Annotated[float, msgspec.Meta(gt=0.0, description="End after so long a silence, in seconds")]
Duration = Annotated[float, msgspec.Meta(gt=0.0, description="Travel time in seconds")]
_STILL: Vector3 = (0.0, 0.0, 0.0)


class JogCommand(Message, frozen=True, kw_only=True):
    """How fast to go from now on, on `<arm>/jog`: rad/s a joint for JogJoints; m/s, then rad/s for JogTool."""

    velocity: tuple[float, ...]


class JogCollisionOptions(Message, frozen=True, kw_only=True):
    """What of the planning scene a jog minds: nothing where it is not `minded`.

    It stays `margin_m` away from obstacles, other arms and what cameras see, but for the names in `may_touch`,
    such as a part that is to be gripped. An arm that is nearer already may go away.
    """

    minded: bool = True
    margin_m: Margin = 0.005
    may_touch: tuple[str, ...] = ()


class JointJogFeedback(Message, frozen=True, kw_only=True):
    """Where the arm is, radians, and what holds it back, in words; empty where nothing does."""

    joints: tuple[float, ...]
    held_by: str = ""


class ToolJogFeedback(Message, frozen=True, kw_only=True):
    """Where the tool centre point is, and what holds the arm back, in words; empty where nothing does."""

    pose: Pose
    held_by: str = ""


class JogJoints(Action[JointMotionResult, JointJogFeedback], frozen=True, kw_only=True):
    """Turn the joints at `velocity_rad_s` for `duration_s`, or as `<arm>/jog` tells when both are left out.

    Slows down before a joint limit and stands still at it.
    """

    velocity_rad_s: tuple[float, ...] = ()
    duration_s: Duration | None = None
    watchdog_s: WatchdogTime = 0.2
    idle_s: IdleTimeout = 5.0
    scene: JogCollisionOptions = JogCollisionOptions()


class JogTool(Action[CartMotionResult, ToolJogFeedback], frozen=True, kw_only=True):
    """Move the tool at a velocity for `duration_s`, or as `<arm>/jog` tells when both are left out.

    `velocity` is m/s along and rad/s about the axes of `frame`, at the tool centre point. Where a
    joint limit or a singularity is near, the whole velocity becomes smaller.
    """

    velocity: tuple[float, ...] = ()
    frame: Axes = "world"
    duration_s: Duration | None = None
    watchdog_s: WatchdogTime = 0.2
    idle_s: IdleTimeout = 5.0
    scene: JogCollisionOptions = JogCollisionOptions()


class StepJoints(Action[JointMotionResult, JointMotionFeedback], frozen=True, kw_only=True):
    """Turn the joints by `step_rad`, one value a joint; rejected beforehand where a limit is in the way."""

    step_rad: tuple[float, ...]
    speed: Speed = 0.1
    scene: JogCollisionOptions = JogCollisionOptions()


class StepTool(Action[CartMotionResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move the tool straight by `step_m` and turn it by the rotation vector `turn_rad`, along the axes of `frame`."""

    step_m: Vector3 = _STILL
    turn_rad: Vector3 = _STILL
    frame: Axes = "world"
    speed_m_s: Annotated[float, msgspec.Meta(gt=0.0, le=0.5, description="Greatest speed on the way")] = 0.05
    scene: JogCollisionOptions = JogCollisionOptions()
