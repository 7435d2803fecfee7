"""The model of a tool at the flange, as data: joints, links, tool centre point and mechanism."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

Triple = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class PadBox:
    """The rubber tip of one finger as a box: centre in the finger link's frame, full edge lengths, metres."""

    link: str
    xyz: Triple
    size_m: Triple


@dataclass(frozen=True, kw_only=True)
class GripperModel:
    """A parallel gripper with two sliding fingers (kind `parallel`).

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
    armature_kg: float = 0.2


@dataclass(frozen=True, kw_only=True)
class LinkageModel:
    """A two-finger gripper whose fingers are driven through a linkage by one motor (kind `linkage`).

    `driver` turns from `open_rad` (opening `max_width_m`) to `closed_rad` (minimum opening); the joints
    in `followers` turn by their factor of it.
    """

    driver: str
    followers: tuple[tuple[str, float], ...]
    finger_links: tuple[str, str]
    pads: tuple[PadBox, PadBox]
    open_rad: float
    closed_rad: float
    max_width_m: float
    max_speed_m_s: float
    min_force_n: float
    max_force_n: float
    armature_kg_m2: float


@dataclass(frozen=True, kw_only=True)
class MagnetModel:
    """A switchable magnet (kind `magnet`): it holds objects at its face with up to `max_force_n`.

    `face` is the flat pole face, its box's z axis pointing out of it; ferrous parts within `reach_m` of it are
    attracted. The field takes `switch_s` to rise or fall.
    """

    face: PadBox
    max_force_n: float
    reach_m: float
    max_payload_kg: float
    switch_s: float = 0.2


@dataclass(frozen=True, kw_only=True)
class SynergyJoint:
    """One flexion joint on the tendon: pulley radius in metres, spring in N m/rad, damper in N m s/rad."""

    name: str
    radius_m: float
    stiffness_nm_rad: float
    damping_nms_rad: float


@dataclass(frozen=True, kw_only=True)
class SynergyModel:
    """A soft hand: one motor pulls one tendon that runs over all flexion joints (kind `synergy`).

    Closing by a share s winds up s * `travel_m` of tendon; a blocked finger stops while the
    others continue. Passive joints (abduction) have springs only.
    """

    palm_link: str
    fingers: tuple[tuple[str, ...], ...]
    """Links of each finger from knuckle to tip, thumb first."""
    flexion: tuple[SynergyJoint, ...]
    passive: tuple[SynergyJoint, ...]
    travel_m: float
    travel_speed_m_s: float
    max_force_n: float


@dataclass(frozen=True, kw_only=True)
class ClawModel:
    """A claw turned by a hobby servo, both fingers coupled by gears (kind `claw`).

    `driver` turns from `open_rad` to `closed_rad`; the joint in `followers` by its factor of it.
    `servo_open_rad` and `servo_closed_rad` are the angles written to the servo for these two.
    """

    driver: str
    followers: tuple[tuple[str, float], ...]
    finger_links: tuple[str, str]
    pads: tuple[PadBox, PadBox]
    open_rad: float
    closed_rad: float
    servo_open_rad: float
    servo_closed_rad: float
    max_width_m: float
    max_speed_rad_s: float
    max_effort_nm: float
    armature_kg_m2: float


Mechanism = GripperModel | LinkageModel | MagnetModel | SynergyModel | ClawModel


@dataclass(frozen=True, kw_only=True)
class ToolModel:
    """One tool on its arm: names have the prefix of the composed URDF.

    `links` and `joints` are all of its links and moving joints; `root_link` is fixed to the flange;
    `mass_kg` is the sum over its links. The tool centre point is the arm's `RobotModel.tool_link`.
    """

    name: str
    kind: str
    root_link: str
    links: tuple[str, ...]
    joints: tuple[str, ...]
    mass_kg: float
    mechanism: Mechanism
    licence: str
    licence_file: Path
