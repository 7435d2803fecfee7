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


class Wrench(Message, frozen=True, kw_only=True):
    """Force in newton and torque in newton metre, in `frame`."""

    force_n: Vector3
    torque_nm: Vector3
    frame: str


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
    """What a robot says of itself once connected, published as the latest value of `<robot>/description`."""

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
