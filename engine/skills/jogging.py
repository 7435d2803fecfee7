"""Jogging of an arm from a panel, continuously or in steps; served under the arm's name.

Hold-to-run: send JogJoints or JogTool without a velocity and publish `JogCommand`s on `<arm>/jog` while
the key is pressed, then one of zero. After `watchdog_s` without a command the arm comes to rest, and after `idle_s`
the goal ends as succeeded. Cancel the goal to end it at once. One goal serves many presses: another direction, and for
the tool other axes, are only another command.

PrepareJog before the first press: it returns when the collision checks of the arm answer. Why a jog stands before an
obstacle, and which ways lead out, is published on `<arm>/jog_block`.
"""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec

from engine.messages import Message, Pose, Vector3
from engine.skill import Action, Capability, Service
from engine.skills.axes import Axes
from engine.skills.motion import CartMotionFeedback, CartMotionResult, JointMotionFeedback, JointMotionResult, Speed
from engine.skills.planning import Margin

WatchdogTime = Annotated[
    float, msgspec.Meta(gt=0.0, le=2.0, description="Time without a command until the arm comes to rest, in seconds")
]
IdleTimeout = Annotated[
    float, msgspec.Meta(gt=0.0, description="Time without a command until the goal ends, in seconds")
]
Replaceable = Annotated[bool, msgspec.Meta(description="Whether the goal, while it is idle, ends for another goal")]
Duration = Annotated[float, msgspec.Meta(gt=0.0, description="Travel time in seconds")]
_STILL: Vector3 = (0.0, 0.0, 0.0)


PressTime = Annotated[
    float, msgspec.Meta(ge=0.0, le=1.0, description="Shortest time of the press that this command begins, in seconds")
]
CommandAge = Annotated[float, msgspec.Meta(ge=0.0, le=60.0, description="How long ago it was commanded, in seconds")]
MOST_WAIT_S = 0.3
"""The longest time from the release of a press to the start of its motion; then it is dropped."""


class JogCommand(Message, frozen=True, kw_only=True):
    """The commanded velocity on `<arm>/jog`: rad/s per joint for JogJoints; m/s, then rad/s for JogTool.

    With `least_s` it begins a press: once its path is checked the arm moves for at least so long, although a later
    command says otherwise; presses are executed one after the other. A press that does not move the arm within
    `MOST_WAIT_S` of its release is dropped, and counted in the feedback unless it is blocked. A press that falls
    silent without a release ends with the watchdog. `frame` are the axes of this velocity in JogTool, by default
    those of the goal. `age_s` is for how long the command has waited on its way.
    """

    velocity: tuple[float, ...]
    frame: Axes | None = None
    least_s: PressTime = 0.0
    age_s: CommandAge = 0.0


class JogCollisionOptions(Message, frozen=True, kw_only=True):
    """Collision avoidance of a jog; disabled when `minded` is false.

    The arm keeps `margin_m` from obstacles, other arms and occupied space, except the names in `may_touch`,
    such as a part to be grasped. An arm that is closer already may move away.
    """

    minded: bool = True
    margin_m: Margin = 0.005
    may_touch: tuple[str, ...] = ()


class JogDirection(Message, frozen=True, kw_only=True):
    """A direction of a jog: along (0 to 2) or about (3 to 5) an axis of the tool's frame, or a joint by its number."""

    axis: int
    sign: int


class JogReady(Message, frozen=True, kw_only=True):
    """An arm is ready to be jogged; the preparation took `waited_s`."""

    waited_s: float


class JogBlock(Message, frozen=True, kw_only=True):
    """What a jog of an arm stands before: two bodies, by name, and their distance in metres; empty when nothing does.

    `directions_out` are the directions of the jog, in its axes, that take the two apart. Both follow the names:
    `distance_m` is None until they are measured.
    """

    robot: str
    first: str = ""
    second: str = ""
    distance_m: float | None = None
    directions_out: tuple[JogDirection, ...] = ()


class PrepareJog(Service[JogReady], frozen=True, kw_only=True):
    """Return when a jog of the arm would start at once: its planning scene and the checks of its path are loaded.

    Fails with the reason where paths cannot be checked.
    """


class JointJogFeedback(Message, frozen=True, kw_only=True):
    """The present configuration, radians, and the reason why the motion is limited; empty when it is not.

    `dropped` counts the presses of this goal that were released before the arm could move.
    """

    joints: tuple[float, ...]
    held_by: str = ""
    dropped: int = 0


class ToolJogFeedback(Message, frozen=True, kw_only=True):
    """The present pose of the tool centre point, and the reason why the motion is limited; empty when it is not.

    `dropped` counts the presses of this goal that were released before the arm could move.
    """

    pose: Pose
    held_by: str = ""
    dropped: int = 0


class JogJoints(Action[JointMotionResult, JointJogFeedback], frozen=True, kw_only=True):
    """Move the joints at `velocity_rad_s` for `duration_s`, or as commanded on `<arm>/jog` when both are omitted.

    Decelerates before a joint limit and stops at it.
    """

    capability: ClassVar[Capability] = "stream"

    velocity_rad_s: tuple[float, ...] = ()
    duration_s: Duration | None = None
    watchdog_s: WatchdogTime = 0.2
    idle_s: IdleTimeout = 5.0
    replaceable: Replaceable = False
    scene: JogCollisionOptions = JogCollisionOptions()


class JogTool(Action[CartMotionResult, ToolJogFeedback], frozen=True, kw_only=True):
    """Move the tool at a velocity for `duration_s`, or as commanded on `<arm>/jog` when both are omitted.

    `velocity` is m/s along and rad/s about the axes of `frame`, at the tool centre point. Near a
    joint limit or a singularity, the whole velocity is scaled down.
    """

    capability: ClassVar[Capability] = "stream"

    velocity: tuple[float, ...] = ()
    frame: Axes = "world"
    duration_s: Duration | None = None
    watchdog_s: WatchdogTime = 0.2
    idle_s: IdleTimeout = 5.0
    replaceable: Replaceable = False
    scene: JogCollisionOptions = JogCollisionOptions()


class StepJoints(Action[JointMotionResult, JointMotionFeedback], frozen=True, kw_only=True):
    """Move the joints by `step_rad`, one value per joint; rejected before the motion when a joint limit is exceeded."""

    capability: ClassVar[Capability] = "trajectory"

    step_rad: tuple[float, ...]
    speed: Speed = 0.1
    scene: JogCollisionOptions = JogCollisionOptions()


class StepTool(Action[CartMotionResult, CartMotionFeedback], frozen=True, kw_only=True):
    """Move the tool straight by `step_m` and rotate it by the rotation vector `turn_rad`, in the axes of `frame`."""

    capability: ClassVar[Capability] = "trajectory"

    step_m: Vector3 = _STILL
    turn_rad: Vector3 = _STILL
    frame: Axes = "world"
    speed_m_s: Annotated[float, msgspec.Meta(gt=0.0, le=0.5, description="Maximum speed of the tool")] = 0.05
    scene: JogCollisionOptions = JogCollisionOptions()
