"""The typed messages that robots, states and the browser exchange over the bus.

SI units, quaternions are x y z w, angles in radians. Poses are expressed in the
frame that the message names; `world` is the cell's root frame.
"""

from __future__ import annotations

import msgspec

Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class Message(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Root of everything published on a topic or carried by a skill."""


class Pose(Message, frozen=True, kw_only=True):
    """A rigid transform: position in metres and unit quaternion x y z w, in `frame`."""

    xyz: Vector3
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)
    frame: str = "world"


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


class Wrench(Message, frozen=True, kw_only=True):
    """Force in newton and torque in newton metre, in `frame`."""

    force_n: Vector3
    torque_nm: Vector3
    frame: str


class ExternalTorque(Message, frozen=True, kw_only=True):
    """The joint torque that the environment exerts on a robot, estimated, without the load that it knows of."""

    time_s: float
    names: tuple[str, ...]
    torque_nm: tuple[float, ...]


class FrameTransform(Message, frozen=True, kw_only=True):
    """The pose of `child` in `parent`."""

    parent: str
    child: str
    xyz: Vector3
    xyzw: Quaternion


class VisualGeometry(Message, frozen=True, kw_only=True):
    """One drawable body of the cell, fixed to `frame`.

    `kind` is box (full edge lengths), cylinder (radius, length), sphere (radius) or mesh;
    a mesh has float32 vertices (n x 3, metres) and uint32 faces (m x 3), both row-major bytes.
    """

    name: str
    frame: str
    kind: str
    size_m: tuple[float, ...] = ()
    vertices: bytes = b""
    faces: bytes = b""
    rgba: tuple[float, float, float, float] = (0.7, 0.7, 0.7, 1.0)
    xyz: Vector3 = (0.0, 0.0, 0.0)
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)


class SceneDescription(Message, frozen=True, kw_only=True):
    """Everything that can be drawn, published once as the latest value of `cell/scene`."""

    geometries: tuple[VisualGeometry, ...]


class FramePoses(Message, frozen=True, kw_only=True):
    """World poses of all moving frames at one instant: row i is names[i], xyz and xyzw."""

    time_s: float
    names: tuple[str, ...]
    xyz: tuple[Vector3, ...]
    xyzw: tuple[Quaternion, ...]


class PartPoses(Message, frozen=True, kw_only=True):
    """Where the known parts of the cell lie, in the world frame."""

    time_s: float
    poses: dict[str, Pose]


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
