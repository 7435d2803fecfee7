"""What robots and their tools say of themselves: joints, grippers, hands, magnets, descriptions."""

from __future__ import annotations

from engine.messages.geometry import Message, Pose


class JointState(Message, frozen=True, kw_only=True):
    """Measured joints of one robot at `time_s` of its own clock."""

    time_s: float
    names: tuple[str, ...]
    position_rad: tuple[float, ...]
    velocity_rad_s: tuple[float, ...]
    effort_nm: tuple[float, ...]


class GripperState(Message, frozen=True, kw_only=True):
    """Measured state of a two-finger gripper: opening between the pads and force on them."""

    time_s: float
    width_m: float
    force_n: float
    held: bool


class HandState(Message, frozen=True, kw_only=True):
    """Measured state of a hand with one motor: how far it is closed (0 open, 100 closed), how hard it presses."""

    time_s: float
    closed_percent: float
    force_n: float
    held: bool
    part: str = ""
    """What is held, `?` where the hand cannot tell, empty for nothing."""


class MagnetState(Message, frozen=True, kw_only=True):
    """Measured state of a switchable magnet: how hard it pulls at what touches its face."""

    time_s: float
    on: bool
    pull_n: float
    held: bool
    part: str = ""
    """What is held, `?` where the magnet cannot tell, empty for nothing."""


class ExternalTorque(Message, frozen=True, kw_only=True):
    """The joint torque that the environment exerts on a robot, estimated, without the load that it knows of."""

    time_s: float
    names: tuple[str, ...]
    torque_nm: tuple[float, ...]


class RobotDescription(Message, frozen=True, kw_only=True):
    """What a robot says of itself once connected, published as the latest value of `<robot>/description`.

    `urdf` is of arm and tool together. `tool` is the name of the tool's model, empty for a bare flange;
    `calibration` the hash of the factory calibration that is applied, empty for the nominal arm.
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
