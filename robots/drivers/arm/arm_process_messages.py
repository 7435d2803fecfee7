"""What the control process of a real arm and its parent say to one another, besides motion events."""

from __future__ import annotations

import msgspec

from engine.messages import Vector3
from robots.control.commanding.arm_commands import ArmCommand, ControlCommand, MotionCommand
from robots.control.motion_event import AnyMotionEvent
from robots.drivers.arm.joint_controller import ControllerIdentity
from robots.io.request_failure import RequestFailure
from robots.port.heartbeat import ENGINE_SILENCE_S
from robots.scene.sim_scene import ArmPlacement

Maker = str
"""The place of a function, `module:NAME`: a `JointController` from the options of a driver and a `WireCapture`."""


class OpenController(ControlCommand, frozen=True, kw_only=True, tag="open_controller"):
    """Request: connect for reading; always the first message, answered by `ControllerOpened`.

    `options` are those of the driver, encoded as JSON. `stale_s` is how long the controller may say nothing new.
    `capture` is the folder to which its connections are captured, empty for none.
    """

    arm: ArmPlacement
    controller: Maker
    options: bytes
    stale_s: float
    gravity_m_s2: Vector3 = (0.0, 0.0, -9.81)
    engine_silence_s: float = ENGINE_SILENCE_S
    capture: str = ""


class EnableController(ControlCommand, frozen=True, kw_only=True, tag="enable_controller"):
    """Request: accept set points; answered by `ControllerEnabled` or a failure with the cause."""


class SetControllerOutput(ControlCommand, frozen=True, kw_only=True, tag="set_output"):
    """Request: set a digital output; answered by `OutputSet` once the controller reads it back."""

    output: int
    on: bool


class CloseController(ControlCommand, frozen=True, kw_only=True, tag="close_controller"):
    """Bring the arm to rest and end the process."""


class ControllerOpened(msgspec.Struct, frozen=True, kw_only=True, tag="controller_opened"):
    """The controller is read; what it says of itself."""

    identity: ControllerIdentity


class ControllerEnabled(msgspec.Struct, frozen=True, kw_only=True, tag="controller_enabled"):
    """The arm accepts set points."""


class OutputSet(msgspec.Struct, frozen=True, kw_only=True, tag="output_set"):
    """The controller reads back what was set."""


class MotionProblem(msgspec.Struct, frozen=True, kw_only=True, tag="motion_problem"):
    """Why the arm may not move from now on; empty once it may."""

    problem: str
    hint: str = ""


class SafetyState(msgspec.Struct, frozen=True, kw_only=True, tag="safety_state"):
    """Why the controller does not move, by name; empty while it can. Said before the arm is enabled too."""

    stopped_by: str


class ControllerGone(msgspec.Struct, frozen=True, kw_only=True, tag="controller_gone"):
    """The last message: the controller is lost, and this process ends."""

    reason: str
    hint: str = ""


ToArmProcess = OpenController | EnableController | SetControllerOutput | CloseController | ArmCommand | MotionCommand
FromArmProcess = (
    ControllerOpened
    | ControllerEnabled
    | OutputSet
    | MotionProblem
    | SafetyState
    | ControllerGone
    | RequestFailure
    | AnyMotionEvent
)
