"""Messages of the teaching page: the frames of its websocket, and the bodies of its routes."""

from __future__ import annotations

from typing import Annotated, Literal, get_args

import msgspec
from pydantic import Field

from editor_web.http_bodies.common_bodies import HttpBody
from engine.skills.dmp import CartFit, JointFit
from engine.skills.motion_trace import Trace
from engine.skills.teaching import TeachStatus

Word = Annotated[str, msgspec.Meta(pattern="^[a-z0-9_]{1,40}$")]
Name = Annotated[str, msgspec.Meta(max_length=200)]
Space = Literal["joints", "tool"]
Axes = Literal["world", "base", "tool"]


class ArmInfo(msgspec.Struct, frozen=True, kw_only=True):
    """Description of an arm: its joints with their limits (rad, rad/s), its tool, and the names of its skills."""

    name: str
    model: str
    joint_names: tuple[str, ...]
    lower_rad: tuple[float, ...]
    upper_rad: tuple[float, ...]
    velocity_rad_s: tuple[float, ...]
    tool: str
    skills: tuple[str, ...]


class ToolLive(msgspec.Struct, frozen=True, kw_only=True):
    """Measured tool state: opening of a gripper (m) or closing of a hand (0 to 100), and whether it holds a part."""

    width_m: float | None = None
    closed_percent: float | None = None
    held: bool = False


class ArmLive(msgspec.Struct, frozen=True, kw_only=True):
    """Status of an arm: joints in radians, `tool_pose` x y z (m), quaternion x y z w, in the world."""

    mode: str
    activity: str
    error: str
    joints: tuple[float, ...]
    tool_pose: tuple[float, ...]
    tool: ToolLive | None


class ArmInfoFrame(msgspec.Struct, frozen=True, kw_only=True, tag="arms", tag_field="k"):
    """First frame: the arms and frames of the cell; `can_push` is true if bodies can be pushed, as in a simulation."""

    arms: tuple[ArmInfo, ...]
    can_push: bool
    frames: tuple[str, ...] = ()


class ArmsLiveFrame(msgspec.Struct, frozen=True, kw_only=True, tag="now", tag_field="k"):
    """The arms whose status has changed, at most ten times a second."""

    arms: dict[str, ArmLive]


class HelpingHandFrame(msgspec.Struct, frozen=True, kw_only=True, tag="hand", tag_field="k"):
    """Status of the Helping Hand; null if there is none."""

    status: TeachStatus | None


class EntriesChanged(msgspec.Struct, frozen=True, kw_only=True, tag="entries", tag_field="k"):
    """Entries of the store have changed."""


class JogStatus(msgspec.Struct, frozen=True, kw_only=True, tag="jogging", tag_field="k"):
    """The arm that this page jogs, empty for none, and what limits its motion, as text."""

    arm: str
    held_by: str = ""


class RefusedFrame(msgspec.Struct, frozen=True, kw_only=True, tag="refused", tag_field="k"):
    """A message of the page was refused; `what` is its kind."""

    what: Literal["jog", "button", "look"]
    message: str
    hint: str


class StartJog(msgspec.Struct, frozen=True, kw_only=True, tag="jog", tag_field="k"):
    """From the page: prepare to jog this arm, until `rest`."""

    arm: Name
    space: Space
    frame: Axes = "world"


class JogVelocity(msgspec.Struct, frozen=True, kw_only=True, tag="go", tag_field="k"):
    """From the page, ten times a second or more while a key is down: move at this velocity, m/s and rad/s."""

    velocity: Annotated[tuple[float, ...], msgspec.Meta(max_length=32)]


class StopJog(msgspec.Struct, frozen=True, kw_only=True, tag="rest", tag_field="k"):
    """From the page: the key is up."""


class ButtonInput(msgspec.Struct, frozen=True, kw_only=True, tag="button", tag_field="k"):
    """From the page: a button of a keyboard or gamepad, to publish on `buttons/<source>/<button>`."""

    source: Word
    button: Word
    value: bool


class PreviewTaught(msgspec.Struct, frozen=True, kw_only=True, tag="look", tag_field="k"):
    """From the page: preview this arm along an entry (`kind`, `name`) or a capture; without an arm, clear the preview.

    `revision` selects a revision of the entry, 0 the current one. `place` 0 replaces all previews; places 1 to 4 are
    shown side by side, each in its colour.
    """

    arm: Name = ""
    kind: Name = ""
    name: Name = ""
    capture: int = 0
    revision: int = 0
    place: Annotated[int, msgspec.Meta(ge=0, le=4)] = 0


class PrimitiveComparison(msgspec.Struct, frozen=True, kw_only=True):
    """A recording and the primitive learned from it, as the arm would execute them, and their fit errors."""

    demonstration: Trace | None
    primitive: Trace | None
    joint_fit: JointFit | None
    cart_fit: CartFit | None


class EntryRow(msgspec.Struct, frozen=True, kw_only=True):
    """A named entry and its last change: by whom, why, and when (milliseconds since 1970)."""

    kind: str
    name: str
    revision: int
    tags: tuple[str, ...]
    by: str
    reason: str
    changed_unix_ms: int


class EntryPage(msgspec.Struct, frozen=True, kw_only=True):
    """The first matching entries, and the total number."""

    entries: tuple[EntryRow, ...]
    total: int


class TagsBody(HttpBody):
    """New tags of an entry; `revision` is the revision that they are based on."""

    kind: str = Field(max_length=200)
    name: str = Field(max_length=200)
    tags: tuple[Annotated[str, Field(max_length=64)], ...] = Field(max_length=32)
    revision: int = Field(ge=1, le=2**53)


class PlayBody(HttpBody):
    """Play back an entry (`kind`, `name`) or a capture with an arm; `speed` is a fraction of the taught speed."""

    arm: str = Field(max_length=200)
    speed: float = Field(gt=0.0, le=0.5)
    kind: str = Field(default="", max_length=200)
    name: str = Field(default="", max_length=200)
    capture: int = Field(default=0, ge=0, le=2**53)
    revision: int = Field(default=0, ge=0, le=2**53)


class PlaybackResult(msgspec.Struct, frozen=True, kw_only=True):
    """The end of a playback: `succeeded`, `preempted`, `rejected` or `failed`, and the cause."""

    status: str
    cause: str


class PushToolBody(HttpBody):
    """Push the tool of a simulated arm, along the world axes."""

    arm: str = Field(max_length=200)
    force_n: tuple[float, float, float]
    duration_s: float = Field(gt=0.0, le=2.0)


ToPage = ArmInfoFrame | ArmsLiveFrame | HelpingHandFrame | EntriesChanged | JogStatus | RefusedFrame
FromPage = StartJog | JogVelocity | StopJog | ButtonInput | PreviewTaught
SCHEMAS = (*get_args(ToPage), *get_args(FromPage), PrimitiveComparison, EntryPage, PlaybackResult)
"""Sources of the page's types, in addition to the bodies of the routes."""
