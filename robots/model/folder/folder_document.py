"""The schema of `robot.yaml` and `tool.yaml` of a model folder, as strict frozen models.

Lengths are metres, angles radians, masses kilograms, forces newtons. `file` paths are relative to
the folder, or to an installed `package` when one is named.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.document import StrictModel
from robots.model.mechanism import Mechanism, Positive, Text, Triple

Name = Annotated[str, Meta(pattern="^[a-z][a-z0-9_]{0,63}$", description="Lower-case letters, digits and `_`")]


class FileReference(StrictModel, frozen=True, kw_only=True):
    """A file in the model's folder, or in an installed Python package."""

    file: Text
    package: Text | None = None


class UrdfSource(FileReference, frozen=True, kw_only=True):
    """The URDF. `collision_file` is another URDF with the same links whose collision shapes are used.

    `root` is the first link of the model (the URDF's root by default); the links in `without` are removed
    with all their descendants.
    """

    collision_file: Text | None = None
    root: Text | None = None
    without: tuple[Text, ...] = ()


class Licence(FileReference, frozen=True, kw_only=True):
    """The licence of the description: its name (SPDX where there is one) and the file with its text."""

    name: Text


class ArmJoint(StrictModel, frozen=True, kw_only=True):
    """One arm joint: name in the URDF, range, limits, home, inertia of the motor seen at the joint, nominal friction.

    Controllers compensate the friction that is given here, none by default; the dampers of the URDF are not part of it.
    """

    name: Text
    lower_rad: float
    upper_rad: float
    velocity_rad_s: Positive
    acceleration_rad_s2: Positive
    jerk_rad_s3: Positive
    effort_nm: Positive
    home_rad: float
    armature_kg_m2: Annotated[float, Meta(ge=0.0)] = 0.1
    coulomb_nm: Annotated[float, Meta(ge=0.0)] = 0.0
    viscous_nms_rad: Annotated[float, Meta(ge=0.0)] = 0.0


class DeviceJoint(StrictModel, frozen=True, kw_only=True):
    """The controller's angle of a joint: the joint plus factors of other joints, plus an offset.

    `lower_rad` and `upper_rad` are the controller's range of its own angle, if it differs from the one
    implied by the joints' ranges. With `optional: true` this applies only to robots
    whose cell entry has `coupled_joints: true`.
    """

    joint: Text
    plus: dict[str, float] = {}
    offset_rad: float = 0.0
    lower_rad: float | None = None
    upper_rad: float | None = None
    optional: bool = False


class CalibrationFormat(StrictModel, frozen=True, kw_only=True):
    """Support of factory calibration files, and the names of their segments.

    `joints` lists the joint at the start of each segment, in order; `nominal` is the calibration
    file that describes the URDF unchanged; `base_rpy` rotates the file's base to `base_link`.
    """

    format: Literal["universal_robots"]
    nominal: Text
    joints: dict[str, str]
    base_rpy: Triple = (0.0, 0.0, 0.0)


class CollisionPairs(StrictModel, frozen=True, kw_only=True):
    """Pairs of links that may touch or can never collide: from an SRDF, and listed."""

    srdf: FileReference | None = None
    allowed: tuple[tuple[str, str], ...] = ()


class RobotDocument(StrictModel, frozen=True, kw_only=True):
    """A `robot.yaml`: one arm."""

    flexcell: Literal[1]
    robot: Name
    title: Text
    sources: str = ""
    urdf: UrdfSource
    flange: Text
    tool: Text | None = None
    """Name of the tool delivered with the arm."""
    joints: Annotated[tuple[ArmJoint, ...], Meta(min_length=1)]
    device_joints: tuple[DeviceJoint, ...] = ()
    calibration: CalibrationFormat | None = None
    digital_outputs: Annotated[int, Meta(ge=0, description="General purpose outputs of the controller")] = 0
    digital_inputs: Annotated[int, Meta(ge=0, description="General purpose inputs of the controller")] = 0
    collisions: CollisionPairs = CollisionPairs()
    licence: Licence


class MountPose(StrictModel, frozen=True, kw_only=True):
    """A pose: position, and rotation about fixed x, y, z axes in turn."""

    xyz: Triple = (0.0, 0.0, 0.0)
    rpy: Triple = (0.0, 0.0, 0.0)


class ToolCentrePoint(MountPose, frozen=True, kw_only=True):
    """The tool centre point, in the frame of `link` (the tool's root by default)."""

    link: Text | None = None


class ToolDocument(StrictModel, frozen=True, kw_only=True):
    """A `tool.yaml`: one tool; which mechanisms there are is added where it is read.

    `mount` is the pose of its root link in the flange (z out of the flange). On the arm its links and joints
    have the prefix `prefix`, by default the tool's name and `_`; the names in this
    file are those of its own URDF. The root link gets the mass missing to `mass_kg`.
    """

    flexcell: Literal[1]
    tool: Name
    title: Text
    sources: str = ""
    urdf: UrdfSource
    prefix: str | None = None
    mount: MountPose = MountPose()
    tcp: ToolCentrePoint = ToolCentrePoint()
    mass_kg: Positive | None = None
    mechanism: Mechanism
    collisions: CollisionPairs = CollisionPairs()
    licence: Licence
