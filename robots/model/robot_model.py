"""The model of a robot arm with its tool, as data: one URDF text, joints, limits, tool, home, licence."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from robots.model.finger_mechanisms import GripperModel
from robots.model.joint_map import JointMap
from robots.model.tool_model import ToolModel


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
class JointFriction:
    """Nominal friction per arm joint, in the order of `RobotModel.arm_joints`; zero where it is not known."""

    coulomb_nm: tuple[float, ...]
    viscous_nms_rad: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class RobotModel:
    """One arm with the tool at its flange, composed of its folder, its tool's folder and its calibration.

    `urdf_text` is the only description used by kinematics, dynamics, collision, simulation, view and
    bus: visual and collision shapes, the tool joined to `flange_link` by a fixed joint. Its mesh
    `filename`s are `package://<path>` below one of `package_dirs` (see `description.resolve_uri`).
    The root of the URDF is `base_link`. `tool_link` is the link whose origin is the tool centre point
    (the flange without a tool). `allowed_collisions` are pairs of links that never collide or may
    touch. `home_rad` is the resting configuration. `joint_map` maps to the angles of the robot's
    controller.
    """

    name: str
    title: str
    urdf_text: str
    package_dirs: tuple[Path, ...]
    base_link: str
    flange_link: str
    tool_link: str
    arm_joints: tuple[str, ...]
    limits: JointLimits
    friction: JointFriction
    home_rad: tuple[float, ...]
    armature_kg_m2: tuple[float, ...]
    tool: ToolModel | None
    allowed_collisions: tuple[tuple[str, str], ...]
    joint_map: JointMap
    calibration: str
    """Hash of the applied factory calibration, empty for the nominal arm."""
    licence: str
    licence_file: Path
    digital_outputs: int = 0
    """General purpose outputs of the robot's controller, numbered from 0."""
    digital_inputs: int = 0
    """General purpose inputs of the robot's controller, numbered from 0."""

    @property
    def dof(self) -> int:
        """Number of arm joints n, tool joints not counted."""
        return len(self.arm_joints)

    @property
    def gripper(self) -> GripperModel | None:
        """The parallel gripper at the flange; None without a tool and for tools of another kind."""
        mechanism = self.tool.mechanism if self.tool is not None else None
        return mechanism if isinstance(mechanism, GripperModel) else None
