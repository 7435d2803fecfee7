"""Teaching over the bus, served under `teach` (RCY 7.1): triggers, captures, and saving captures as entries."""

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

    `device` and `button` are lower-case words; anybody may publish on the topic.
    """

    value: bool


class Trigger(Message, frozen=True, kw_only=True):
    """A trigger with its callback and robot; the fields of RCY figure 12.

    The topic's field `field` (when empty, the only boolean one, or `value` or `data`) is compared
    with `trig_value`: `rising_edge` fires when they become equal, `falling_edge` when they become unequal,
    `hold` is active while they are equal.
    `joint_dmp_N` is the number of kernels of the primitive, 0 selects it by the fit. `tf_save` captures the pose of
    `source_frame` in `target_frame`, `gripper_save` the opening of the gripper and whether it holds a part.
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
    """One capture in the buffer: its time, trigger, robot and kind.

    `form` is the default kind of entry to save it as. `samples` and `duration_s` are 0 for a
    single configuration; `length_rad` is the path length of all joints together, `peak_rad_s` the greatest
    speed of a joint. `saved_as` names the entries saved from it.
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
    """A capture with all its data; missing data is None or empty."""

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
    """A trigger, the type of its topic's messages, and whether its button is pressed.

    `fault` is the reason why it cannot fire, such as a missing field of the messages; empty when it can.
    """

    trigger: Trigger
    message_type: str
    pressed: bool
    fault: str = ""


class TeachStatus(Message, frozen=True, kw_only=True, rename={"message": "said"}):
    """The status of the Helping Hand, also the latest value of `teach/status`.

    `recording` and `guided` are names of robots; `message`, in JSON `said`, is the last thing that it reported, such as
    why a capture was refused.
    """

    triggers: tuple[TriggerStatus, ...]
    captures: tuple[CaptureSummary, ...]
    recording: tuple[str, ...]
    guided: tuple[str, ...]
    message: str = ""


class ReadTeachStatus(Service[TeachStatus], frozen=True, kw_only=True):
    """Return the status of the Helping Hand."""


class SetTriggers(Service[TeachStatus], frozen=True, kw_only=True):
    """Replace the triggers; an active recording ends and is kept."""

    triggers: tuple[Trigger, ...]


class FireTrigger(Service[TeachStatus], frozen=True, kw_only=True):
    """Execute a trigger as if its button had been pressed (`pressed`) or released."""

    trig_name: str
    pressed: bool = True


class TeachNow(Service[TeachStatus], frozen=True, kw_only=True):
    """Execute `callback` for `robot` without a trigger.

    `pressed` starts a recording or gravity compensation, not `pressed` ends it; other callbacks require `pressed`.
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

    `form` selects another kind than the default: every recording can be saved as `trajectory`,
    `dmp` or `cart_dmp`, and its last configuration as `joints` or `pose`.
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
    """Discard a capture; a missing one is not an error."""

    id: int
