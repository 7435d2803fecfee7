"""Geometry: poses, transforms and wrenches, and the base of all messages.

SI units, quaternions x y z w, angles in radians. Poses are expressed in the
frame that the message names; `world` is the cell's root frame.
"""

from __future__ import annotations

import msgspec

Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Vector6 = tuple[float, float, float, float, float, float]
"""Along x y z, then about x y z."""


class Message(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of all messages of topics and skills."""


class Pose(Message, frozen=True, kw_only=True):
    """A rigid transform: position in metres and unit quaternion x y z w, in `frame`."""

    xyz: Vector3
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)
    frame: str = "world"


class Wrench(Message, frozen=True, kw_only=True):
    """Force in newton and torque in newton metre, in `frame`."""

    force_n: Vector3
    torque_nm: Vector3
    frame: str


DRAWN_ONLY = "~"
"""Is in the name of a frame in which something is drawn, and which nobody aims at."""


class FramePoses(Message, frozen=True, kw_only=True):
    """World poses of all moving frames and of the named ones at one instant: row i is names[i], xyz and xyzw."""

    time_s: float
    names: tuple[str, ...]
    xyz: tuple[Vector3, ...]
    xyzw: tuple[Quaternion, ...]


class PartPoses(Message, frozen=True, kw_only=True, omit_defaults=True):
    """The poses of the known parts of the cell in the world frame.

    `up` is the axis of a part, in its own frame, that points up when the part stands as the cell places it; null for
    a part without one, such as a ball. Parts that are not listed have their z axis up. `joined` are the parts and
    fixtures to which bonds join a part; parts that are not listed are joined to nothing.
    """

    time_s: float
    poses: dict[str, Pose]
    up: dict[str, Vector3 | None] = {}
    joined: dict[str, tuple[str, ...]] = {}
