"""States and descriptions of robots and tools: joints, grippers, hands."""

from __future__ import annotations

from typing import Literal

from msgspec import UNSET, UnsetType

from engine.messages.geometry import Message, Pose

HoldEvidence = Literal["contact", "width", "current", "sensor", "not measured"]
"""What tells which body a tool holds.

Only `contact` names the body. `width` (opening of fingers), `current` (force of its drive) and `sensor` (a switch that
detects a part) tell that something is held, and not what; with `not measured` nothing tells it.
"""


class JointState(Message, frozen=True, kw_only=True):
    """Measured joint state of one robot at `time_s` of its own clock."""

    time_s: float
    names: tuple[str, ...]
    position_rad: tuple[float, ...]
    velocity_rad_s: tuple[float, ...]
    effort_nm: tuple[float, ...]


class JointSetPoint(Message, frozen=True, kw_only=True):
    """The joints that a robot follows at `time_s` of its own clock; empty while it is not connected.

    `deviation_rad` is how far the measured joint that is farthest from it is.
    """

    time_s: float
    names: tuple[str, ...]
    position_rad: tuple[float, ...]
    deviation_rad: float = 0.0


class GripperState(Message, frozen=True, kw_only=True, omit_defaults=True):
    """Measured state of a two-finger gripper: opening between the pads and force on the pads."""

    time_s: float
    width_m: float
    force_n: float
    held: bool
    part: str = ""
    """Name of the held part, `?` when unknown, empty for none."""
    by: HoldEvidence | UnsetType = UNSET


class HandState(Message, frozen=True, kw_only=True):
    """Measured state of a hand with one motor: closing position (0 open, 100 closed) and grip force."""

    time_s: float
    closed_percent: float
    force_n: float
    held: bool
    part: str = ""
    """Name of the held part, `?` when unknown, empty for none."""
    by: HoldEvidence | UnsetType = UNSET


class ExternalTorque(Message, frozen=True, kw_only=True):
    """Estimated joint torque that the environment exerts on a robot, without the known load."""

    time_s: float
    names: tuple[str, ...]
    torque_nm: tuple[float, ...]


class RobotDescription(Message, frozen=True, kw_only=True):
    """The description of a connected robot, the latest value of `<robot>/description`.

    `urdf` describes arm and tool together. `tool` is the name of the tool's model, empty for a bare flange;
    `calibration` is the hash of the applied factory calibration, empty for the nominal arm.
    """

    name: str
    model: str
    urdf: str
    joint_names: tuple[str, ...]
    lower_rad: tuple[float, ...]
    upper_rad: tuple[float, ...]
    velocity_rad_s: tuple[float, ...]
    acceleration_rad_s2: tuple[float, ...]
    base: Pose
    tool_frame: str
    licence: str = ""
    effort_nm: tuple[float, ...] = ()
    jerk_rad_s3: tuple[float, ...] = ()
    tool: str = ""
    tool_kind: str = ""
    tool_licence: str = ""
    calibration: str = ""
