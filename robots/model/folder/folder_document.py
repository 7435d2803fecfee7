"""The schema of `robot.yaml` and `tool.yaml` of a model folder, as strict frozen models.

Lengths are metres, angles radians, masses kilograms, forces newtons. `file` paths are relative to
the folder, or to an installed `package` when one is named.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.document import StrictModel
from robots.model.tool_model import Triple

Text = Annotated[str, Meta(min_length=1)]
Positive = Annotated[float, Meta(gt=0.0, description="A number above 0")]
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
    """One arm joint: name in the URDF, range, limits, home, inertia of the motor seen at the joint."""

    name: Text
    lower_rad: float
    upper_rad: float
    velocity_rad_s: Positive
    acceleration_rad_s2: Positive
    jerk_rad_s3: Positive
    effort_nm: Positive
    home_rad: float
    armature_kg_m2: Annotated[float, Meta(ge=0.0)] = 0.1


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
    collisions: CollisionPairs = CollisionPairs()
    licence: Licence


class MountPose(StrictModel, frozen=True, kw_only=True):
    """A pose: position, and rotation about fixed x, y, z axes in turn."""

    xyz: Triple = (0.0, 0.0, 0.0)
    rpy: Triple = (0.0, 0.0, 0.0)


class ToolCentrePoint(MountPose, frozen=True, kw_only=True):
    """The tool centre point, in the frame of `link` (the tool's root by default)."""

    link: Text | None = None


class PadSpec(StrictModel, frozen=True, kw_only=True):
    """A finger pad as a box: centre in the link's frame, full edge lengths."""

    link: Text
    xyz: Triple = (0.0, 0.0, 0.0)
    size_m: tuple[Positive, Positive, Positive]


class ParallelGripperSpec(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="parallel"):
    """Two sliding fingers; each moves half of the opening, the second mimics the first."""

    hand_link: Text
    finger_joints: tuple[Text, Text]
    finger_links: tuple[Text, Text]
    pads: tuple[PadSpec, PadSpec]
    max_width_m: Positive
    max_speed_m_s: Positive
    max_force_n: Positive
    armature_kg: Positive = 0.2


class LinkageGripperSpec(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="linkage"):
    """Two fingers on a linkage turned by `driver`; `followers` turn by a factor of it."""

    driver: Text
    followers: dict[str, float]
    finger_links: tuple[Text, Text]
    pads: tuple[PadSpec, PadSpec]
    open_rad: float
    closed_rad: float
    max_width_m: Positive
    max_speed_m_s: Positive
    min_force_n: Positive
    max_force_n: Positive
    armature_kg_m2: Positive


class MagnetSpec(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="magnet"):
    """A switchable magnet with a flat pole face."""

    face: PadSpec
    max_force_n: Positive
    reach_m: Positive
    max_payload_kg: Positive
    switch_s: Positive = 0.2


class TendonJoint(StrictModel, frozen=True, kw_only=True):
    """Pulley radius, spring and damper of one joint of a soft hand."""

    name: Text
    radius_m: float = 0.0
    stiffness_nm_rad: Positive
    damping_nms_rad: Positive


class SynergyHandSpec(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="synergy"):
    """One tendon over all flexion joints; `passive` joints have springs only."""

    palm_link: Text
    fingers: tuple[tuple[str, ...], ...]
    flexion: tuple[TendonJoint, ...]
    passive: tuple[TendonJoint, ...] = ()
    travel_m: Positive
    travel_speed_m_s: Positive
    max_force_n: Positive


class ClawSpec(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="claw"):
    """Two fingers coupled by gears and turned by a hobby servo."""

    driver: Text
    followers: dict[str, float]
    finger_links: tuple[Text, Text]
    pads: tuple[PadSpec, PadSpec]
    open_rad: float
    closed_rad: float
    servo_open_rad: float
    servo_closed_rad: float
    max_width_m: Positive
    max_speed_rad_s: Positive
    max_effort_nm: Positive
    armature_kg_m2: Positive


class ToolDocument(StrictModel, frozen=True, kw_only=True):
    """A `tool.yaml`: one tool.

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
    mechanism: ParallelGripperSpec | LinkageGripperSpec | MagnetSpec | SynergyHandSpec | ClawSpec
    collisions: CollisionPairs = CollisionPairs()
    licence: Licence
