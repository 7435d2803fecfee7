"""What a robot arm is, as data: description files, joints, limits, tool, gripper, licence."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, kw_only=True)
class JointLimits:
    """Limits per arm joint, in the order of `RobotModel.arm_joints`; all tuples have length n."""

    lower_rad: tuple[float, ...]
    upper_rad: tuple[float, ...]
    velocity_rad_s: tuple[float, ...]
    acceleration_rad_s2: tuple[float, ...]
    jerk_rad_s3: tuple[float, ...]
    effort_nm: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class PadBox:
    """The rubber tip of one finger as a box: centre in the finger link's frame, full edge lengths, metres."""

    link: str
    xyz: tuple[float, float, float]
    size_m: tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class GripperModel:
    """A two-finger parallel gripper that is part of the arm's description.

    Each finger joint moves half of the opening; both pads touch when the opening is 0.
    `finger_joints[1]` mimics `finger_joints[0]`.
    """

    name: str
    hand_link: str
    finger_joints: tuple[str, str]
    finger_links: tuple[str, str]
    pads: tuple[PadBox, PadBox]
    max_width_m: float
    max_speed_m_s: float
    max_force_n: float


@dataclass(frozen=True, kw_only=True)
class RobotModel:
    """One arm with its tool, as its description files and data sheet give it.

    `urdf` has the visual meshes, `collision_urdf` the same kinematics with primitive collision
    shapes; both may use `package://` URIs below `package_dir`. `tool_link` is a link of the URDF
    whose origin is the tool centre point. `allowed_collisions` are pairs of links that never
    collide or may touch (from the SRDF). `home_rad` is the resting configuration.
    """

    name: str
    urdf: Path
    collision_urdf: Path
    package_dir: Path
    base_link: str
    arm_joints: tuple[str, ...]
    limits: JointLimits
    tool_link: str
    home_rad: tuple[float, ...]
    gripper: GripperModel | None
    allowed_collisions: tuple[tuple[str, str], ...]
    licence: str
    licence_file: Path

    @property
    def dof(self) -> int:
        """Number of arm joints n, gripper joints not counted."""
        return len(self.arm_joints)

    def licence_text(self) -> str:
        """Return the full text of the licence that the description came with."""
        return self.licence_file.read_text(encoding="utf-8")
