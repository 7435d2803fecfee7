"""How an arm behaves between and during its motions: controller, stiffness, tool, load, thresholds (RCY 4.1).

The services are answered under the arm's name and return what is in force afterwards. While a run
holds the arm, others may still read it, change its speed override and recover it; the rest is refused.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages import Message, Quaternion, Vector3, Wrench
from engine.skill import Service

Six = tuple[float, float, float, float, float, float]
ControllerName = Literal["joint_impedance", "cartesian_impedance"]
ArmMode = Literal["disconnected", "fault", "reflex", "idle", "moving", "jogging", "guiding", "direct"]

Share = Annotated[float, msgspec.Meta(ge=0.001, le=1.0, description="Share of their own speed that motions run at")]
Damping = Annotated[float, msgspec.Meta(gt=0.0, le=2.0, description="Damping ratio, 1 is critical")]
Mass = Annotated[
    float, msgspec.Meta(ge=0.0, description="Mass of what the tool carries", extra_json_schema={"unit": "kg"})
]
JointRow = tuple[Annotated[float, msgspec.Meta(gt=0.0)], ...]


class ControlSettings(Message, frozen=True, kw_only=True):
    """What stays in force until it is changed.

    Stiffness is N m/rad for joints, N/m along and N m/rad about the axes of the arm's base for the tool.
    An empty `joint_stiffness_nm_rad` means the nominal one; an empty `collision_torque_nm` and no
    `collision_force_n` mean that no reflex trips. The tool centre point is given in the model's tool
    link, like the centre of mass of the load.
    """

    controller: ControllerName
    joint_stiffness_nm_rad: tuple[float, ...]
    joint_damping_ratio: float
    cartesian_stiffness: Six
    cartesian_damping_ratio: float
    nullspace_stiffness_nm_rad: float
    tool_xyz_m: Vector3
    tool_xyzw: Quaternion
    load_kg: float
    load_com_m: Vector3
    collision_torque_nm: tuple[float, ...]
    collision_force_n: float | None
    speed_override: float


class ArmStatus(Message, frozen=True, kw_only=True):
    """What an arm does and how it behaves; the latest value of `<arm>/status`, told at every change of mode.

    `activity` names the skill that is carried out, or says what a goal waits for. `error` says why the
    last one failed or why the arm stopped by itself; it is empty after one that did not. `external_nm`
    and `wrench` are what the environment does to the joints and to the tool, as measured when this was made.
    """

    mode: ArmMode
    activity: str = ""
    error: str = ""
    settings: ControlSettings
    external_nm: tuple[float, ...]
    wrench: Wrench


class SpeedOverride(Message, frozen=True, kw_only=True):
    """The share of their own speed that all motions run at; the latest value of `<arm>/speed_override`."""

    share: float


class ReadArm(Service[ArmStatus], frozen=True, kw_only=True):
    """Return what the arm does and how it behaves."""


class SetSpeedOverride(Service[ControlSettings], frozen=True, kw_only=True):
    """Let all motions run at `share` of their own speed, the one under way included; anybody may."""

    share: Share


class SetController(Service[ControlSettings], frozen=True, kw_only=True):
    """Choose the law that holds the set point; the arm does not jump."""

    controller: ControllerName


class SetJointImpedance(Service[ControlSettings], frozen=True, kw_only=True):
    """Set the stiffness of the joints in N m/rad, one value a joint (empty: the nominal ones), and their damping."""

    stiffness_nm_rad: JointRow = ()
    damping_ratio: Damping = 1.0


class SetCartesianImpedance(Service[ControlSettings], frozen=True, kw_only=True):
    """Set the stiffness of the tool: N/m along, N m/rad about the axes of the arm's base, and its damping."""

    stiffness: Six
    damping_ratio: Damping = 1.0
    nullspace_stiffness_nm_rad: Annotated[float, msgspec.Meta(ge=0.0)] = 20.0


class SetEndEffectorFrame(Service[ControlSettings], frozen=True, kw_only=True):
    """Put the tool centre point elsewhere, in the model's tool link; Cartesian goals then mean that point.

    Refused while the arm moves.
    """

    xyz_m: Vector3
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)


class SetLoad(Service[ControlSettings], frozen=True, kw_only=True):
    """Tell what the tool carries, so that its weight is compensated; the centre of mass is in the tool link."""

    mass_kg: Mass
    com_m: Vector3 = (0.0, 0.0, 0.0)


class SetCollisionBehavior(Service[ControlSettings], frozen=True, kw_only=True):
    """Set what trips the reflex: external torque of a joint (one value each), external force at the tool.

    An empty `torque_nm` and no `force_n` switch the reflex off.
    """

    torque_nm: JointRow = ()
    force_n: Annotated[float, msgspec.Meta(gt=0.0)] | None = None


class RecoverFromError(Service[ArmStatus], frozen=True, kw_only=True):
    """End a reflex: the arm holds itself where it stands and takes goals again. Anybody may; without one nothing."""
