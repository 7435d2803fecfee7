"""Teaching over the bus, answered under `teach` (RCY 7.1): triggers, captured data, saving it under a name."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages import Message, Pose
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp, JointDmp
from engine.skill import Service
from engine.skills.dmp import CartFit, JointFit
from engine.skills.entries import EntryRecord
from engine.skills.gripper import GripperSetting

TriggerType = Literal["rising_edge", "falling_edge", "hold"]
Callback = Literal["joint_save", "pose_save", "tf_save", "gripper_save", "joint_dmp_save", "cart_dmp_save", "grav_comp"]
CaptureForm = Literal["joints", "pose", "dmp", "cart_dmp", "trajectory", "gripper"]
"""The kinds of entries that a capture can be saved as."""


class ButtonState(Message, frozen=True, kw_only=True):
    """A button of a teaching device, on `buttons/<device>/<button>`: `value` is true while it is pressed.

    `device` and `button` are lower-case words; the topic takes what anybody publishes.
    """

    value: bool


class Trigger(Message, frozen=True, kw_only=True):
    """What fires, and what then happens to which robot; the fields of RCY figure 12.

    The topic's field `field` (the only boolean one, or `value` or `data`, where it is empty) is compared
    with `trig_value`: `rising_edge` fires when they begin to be equal, `falling_edge` when they end to be,
    `hold` lasts as long as they are.
    `joint_dmp_N` is the number of kernels of the primitive, 0 lets the fit decide. `tf_save` captures where
    `source_frame` is in `target_frame`, `gripper_save` how far the gripper is open and whether it holds something.
    """

    trig_name: Annotated[str, msgspec.Meta(min_length=1, max_length=80)]
    robot_ns: str
    trig_topic: Annotated[str, msgspec.Meta(min_length=1, max_length=200)]
    trig_type: TriggerType
    trig_callback: Callback
    trig_value: bool | int | float | str = True
    field: str = ""
    joint_dmp_N: Annotated[int, msgspec.Meta(ge=0, le=184)] = 0  # noqa: N815 - the document's name
    source_frame: str = ""
    target_frame: str = "world"


class CaptureSummary(Message, frozen=True, kw_only=True):
    """One capture in the buffer: when, by which trigger, of which robot, and what it is.

    `form` is what it is saved as where nothing else is asked for. `samples` and `duration_s` are 0 for a
    single configuration; `length_rad` is the way of all joints together, `peak_rad_s` the greatest speed
    of a joint. `saved_as` names the entries that were made of it.
    """

    id: int
    taken_at_s: float
    trigger: str
    robot: str
    form: CaptureForm
    samples: int = 0
    duration_s: float = 0.0
    length_rad: float = 0.0
    peak_rad_s: float = 0.0
    saved_as: tuple[str, ...] = ()
    remark: str = ""


class Capture(Message, frozen=True, kw_only=True):
    """A capture with all its data; what it has not is None or empty."""

    summary: CaptureSummary
    names: tuple[str, ...] = ()
    joints: tuple[float, ...] = ()
    pose: Pose | None = None
    trajectory: Trajectory | None = None
    joint_dmp: JointDmp | None = None
    joint_fit: JointFit | None = None
    cart_dmp: CartDmp | None = None
    cart_fit: CartFit | None = None
    gripper: GripperSetting | None = None


class TriggerStatus(Message, frozen=True, kw_only=True):
    """A trigger, the type of its topic's messages, and whether its button is pressed just now.

    `fault` says why it cannot fire, as where the messages have no such field; empty where it can.
    """

    trigger: Trigger
    message_type: str
    pressed: bool
    fault: str = ""


class TeachStatus(Message, frozen=True, kw_only=True):
    """What the Helping Hand does, also the latest value of `teach/status`.

    `recording` and `guided` are names of robots; `said` is its last word, such as why a capture was refused.
    """

    triggers: tuple[TriggerStatus, ...]
    captures: tuple[CaptureSummary, ...]
    recording: tuple[str, ...]
    guided: tuple[str, ...]
    said: str = ""


class ReadTeachStatus(Service[TeachStatus], frozen=True, kw_only=True):
    """Return what the Helping Hand does."""


class SetTriggers(Service[TeachStatus], frozen=True, kw_only=True):
    """Listen to these triggers from now on, instead of those before; a recording under way ends and is kept."""

    triggers: tuple[Trigger, ...]


class FireTrigger(Service[TeachStatus], frozen=True, kw_only=True):
    """Do what a trigger does, as if its button had been pressed (`pressed`) or let go."""

    trig_name: str
    pressed: bool = True


class TeachNow(Service[TeachStatus], frozen=True, kw_only=True):
    """Do what a trigger with this `callback` would do to `robot`, without one.

    `pressed` begins a recording or lets the arm float, not `pressed` ends it; the others look at `pressed` only.
    """

    callback: Callback
    robot: str
    pressed: bool = True
    source_frame: str = ""
    target_frame: str = "world"


class ReadCapture(Service[Capture], frozen=True, kw_only=True):
    """Return a capture with its data."""

    id: int


class SaveCapture(Service[EntryRecord], frozen=True, kw_only=True):
    """Write a capture to the store as a named entry; it stays in the buffer.

    As what it is, or as `form` where that can be made of it: every recording can be saved as `trajectory`,
    `dmp`, `cart_dmp`, and the last configuration of it as `joints` or `pose`.
    Fails when the entry exists, unless `replace`.
    """

    id: int
    name: str
    form: CaptureForm | None = None
    tags: tuple[str, ...] = ()
    replace: bool = False
    by: str = ""
    reason: str = ""


class DiscardCapture(Service[TeachStatus], frozen=True, kw_only=True):
    """Throw a capture away; one that is not there is no error."""

    id: int
