"""Messages of the teaching page: the frames of its websocket, and the bodies of its routes."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from editor_web.cell_view import Marks
from editor_web.http_bodies.common_bodies import Name, RequestBody
from engine.messages import Quaternion, RobotDescription, Vector3
from engine.skills.dmp import CartFit, JointFit
from engine.skills.entries import EntryChanged
from engine.skills.jogging import JogBlock
from engine.skills.motion_trace import Trace
from engine.skills.teaching import TeachStatus

Word = Annotated[str, Meta(pattern="^[a-z0-9_]{1,40}$")]
Space = Literal["joints", "tool"]
Axes = Literal["world", "base", "tool"]


class ArmInfo(RobotDescription, frozen=True, kw_only=True):
    """An arm with the names of its skills."""

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


class PressDropped(msgspec.Struct, frozen=True, kw_only=True, tag="dropped", tag_field="k"):
    """A press has moved nothing: it was released, and the arm could not begin to move within `within_s` after that."""

    arm: str
    within_s: float


class JogReadiness(msgspec.Struct, frozen=True, kw_only=True, tag="ready", tag_field="k"):
    """Whether an arm can be jogged at once; not ready with a `reason` where its path cannot be checked."""

    arm: str
    ready: bool
    reason: str = ""


class JogBlockFrame(JogBlock, frozen=True, kw_only=True, tag="block", tag_field="k"):
    """What the arm that this page jogs stands before, and which directions lead out; no names for nothing."""


class RefusedFrame(msgspec.Struct, frozen=True, kw_only=True, tag="refused", tag_field="k"):
    """A message of the page was refused; `what` is its kind."""

    what: Literal["jog", "button", "look"]
    message: str
    hint: str


class PrepareJogging(msgspec.Struct, frozen=True, kw_only=True, tag="prepare", tag_field="k"):
    """From the page: this arm is shown to be jogged; answered with its readiness, now and after every stop.

    Without a name no arm is shown any more.
    """

    arm: Name


class StartJog(msgspec.Struct, frozen=True, kw_only=True, tag="jog", tag_field="k"):
    """From the page: a key goes down that jogs this arm, until `rest`."""

    arm: Name
    space: Space
    frame: Axes = "world"


class JogVelocity(msgspec.Struct, frozen=True, kw_only=True, tag="go", tag_field="k"):
    """From the page, ten times a second or more while a key is down: move at this velocity, m/s and rad/s."""

    velocity: Annotated[tuple[float, ...], Meta(max_length=32)]


class StopJog(msgspec.Struct, frozen=True, kw_only=True, tag="rest", tag_field="k"):
    """From the page: the key is up; a press during which the arm has not moved is executed for a moment."""


class ButtonInput(msgspec.Struct, frozen=True, kw_only=True, tag="button", tag_field="k"):
    """From the page: a button of a keyboard or gamepad, to publish on `buttons/<source>/<button>`."""

    source: Word
    button: Word
    value: bool


class TaughtReference(msgspec.Struct, frozen=True, kw_only=True):
    """Names an entry (`kind`, `name`), or a capture by its number; `revision` 0 is the current one of the entry."""

    kind: Name = ""
    name: Name = ""
    capture: Annotated[int, Meta(ge=0, le=2**53)] = 0
    revision: Annotated[int, Meta(ge=0, le=2**53)] = 0


class PreviewTaught(TaughtReference, frozen=True, kw_only=True, tag="look", tag_field="k"):
    """From the page: preview this arm along an entry or a capture; without an arm, clear the preview.

    `place` 0 replaces all previews; places 1 to 4 are shown side by side, each in its colour. `value` is shown in the
    place of an entry: the fields of one of this `kind`.
    """

    arm: Name = ""
    value: dict[str, object] | None = None
    place: Annotated[int, Meta(ge=0, le=4)] = 0


class ShowMarks(Marks, frozen=True, kw_only=True, tag="mark", tag_field="k"):
    """From the page: what is marked in its 3D view, in the place of what was before."""


class ShowItemHandle(msgspec.Struct, frozen=True, kw_only=True, tag="place", tag_field="k"):
    """From the page: show a handle at a pose in the world, or none; it moves nothing, the page is told where it is."""

    at: tuple[Vector3, Quaternion] | None = None
    turns: bool = True


class ItemHandleMoved(msgspec.Struct, frozen=True, kw_only=True, tag="placed", tag_field="k"):
    """To the page: where its handle is dragged in the world; at the phase `end` the mouse is up."""

    phase: Literal["start", "update", "end"]
    xyz: Vector3
    xyzw: Quaternion


class PrimitiveComparison(msgspec.Struct, frozen=True, kw_only=True):
    """A recording and the primitive learned from it, as the arm would execute them, and their fit errors."""

    demonstration: Trace | None
    primitive: Trace | None
    joint_fit: JointFit | None
    cart_fit: CartFit | None


class EntryPage(msgspec.Struct, frozen=True, kw_only=True):
    """The last changes of the first matching entries, and the total number of matching ones."""

    entries: tuple[EntryChanged, ...]
    total: int


class TagsBody(RequestBody, frozen=True, kw_only=True):
    """New tags of an entry; `revision` is the revision that they are based on."""

    kind: Name
    name: Name
    tags: Annotated[tuple[Annotated[str, Meta(max_length=64)], ...], Meta(max_length=32)]
    revision: Annotated[int, Meta(ge=1, le=2**53)]


class PlayBody(TaughtReference, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Play back an entry or a capture with an arm; `speed` is a fraction of the taught speed."""

    arm: Name
    speed: Annotated[float, Meta(gt=0.0, le=0.5)]


class PlaybackResult(msgspec.Struct, frozen=True, kw_only=True):
    """The end of a playback: `succeeded`, `preempted`, `rejected` or `failed`, and the cause."""

    status: str
    cause: str


class PushToolBody(RequestBody, frozen=True, kw_only=True):
    """Push the tool of a simulated arm, along the world axes."""

    arm: Name
    force_n: tuple[float, float, float]
    duration_s: Annotated[float, Meta(gt=0.0, le=2.0)]


ToPage = (
    ArmInfoFrame
    | ArmsLiveFrame
    | HelpingHandFrame
    | EntriesChanged
    | JogStatus
    | PressDropped
    | JogReadiness
    | JogBlockFrame
    | RefusedFrame
    | ItemHandleMoved
)
FromPage = PrepareJogging | StartJog | JogVelocity | StopJog | ButtonInput | PreviewTaught | ShowMarks | ShowItemHandle
