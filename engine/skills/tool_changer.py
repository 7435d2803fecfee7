"""The tool changer of an arm, under the name of the arm: `arm/lock_tool`, and its `arm/tool_changer`."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.messages import Message, Pose, Vector3
from engine.skill import Action, Service

LockEnd = Literal["locked", "missing", "not_locked", "wrong_tool"]
ReleaseEnd = Literal["released", "not_released"]


class ToolChangerState(Message, frozen=True, kw_only=True):
    """What a tool changer was told, and what its sensors tell; the latest value of `<arm>/tool_changer`.

    `tool` is the one that is locked to the arm, empty for a bare flange; `tcp` is the name of its tool centre point
    that is set, empty for none of them. `lock` is `empty` while its output is on and no tool is locked. A tool that
    came off is the `problem` until the lock is opened.
    """

    tool: str = ""
    tcp: str = ""
    lock: Literal["open", "locked", "empty"] = "open"
    outputs: dict[str, bool] = {}
    sensors: dict[str, bool] = {}
    problem: str = ""


class ChangeableTool(Message, frozen=True, kw_only=True):
    """Mass and tool centre points of a tool, in the frame of the face that its plate meets; z points away from the arm.

    `plate` is the pose of the part in that frame.
    """

    name: str
    mass_kg: float
    com_m: Vector3
    tcps: dict[str, Pose]
    plate: Pose


class ToolDescription(Message, frozen=True, kw_only=True):
    """A tool of the cell, and where its place in the hanger is.

    `docked` is the pose in the world of the face of the master plate when it meets the tool in its place.
    """

    tool: ChangeableTool
    docked: Pose


class LockFeedback(Message, frozen=True, kw_only=True):
    """What the sensors tell while the lock moves."""

    sensors: dict[str, bool]


class LockToolResult(Message, frozen=True, kw_only=True):
    """How it ended; where it is not `locked`, the lock is open again, and `reason` says why."""

    ended: LockEnd
    reason: str = ""


class LockTool(Action[LockToolResult, LockFeedback], frozen=True, kw_only=True):
    """Lock the tool whose plate is at the face of the master plate, and set tool centre point and load of the arm.

    Rejected while another tool is on. Succeeds as an action whether or not the tool is locked. A tool that is on
    already gets the tool centre point.
    """

    tool: Annotated[str, Meta(min_length=1, description="The tool that should be there")]
    tcp: Annotated[str, Meta(description="Name of its tool centre point; its first one by default")] = ""


class ReleaseToolResult(Message, frozen=True, kw_only=True):
    """How it ended; the tool is still locked where it is not `released`."""

    ended: ReleaseEnd
    reason: str = ""


class ReleaseTool(Action[ReleaseToolResult, LockFeedback], frozen=True, kw_only=True):
    """Open the lock, and set tool centre point and load of the bare flange.

    Rejected where the tool would fall: more than 5 mm or 3° from its place in the hanger, unless `anywhere`.
    """

    anywhere: Annotated[bool, Meta(description="Open it wherever the arm is: somebody holds the tool")] = False


class ReadToolChanger(Service[ToolChangerState], frozen=True, kw_only=True):
    """Return what is known of the tool changer."""


class DescribeTool(Service[ToolDescription], frozen=True, kw_only=True):
    """Return place, tool centre points and mass of a tool; fails while its hanger is not in the cell."""

    tool: Annotated[str, Meta(min_length=1, description="Name of the tool")]
