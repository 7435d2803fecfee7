"""Control settings of an arm: controller, stiffness, tool, load, thresholds (RCY 4.1).

The services are served under the arm's name and return the settings in force afterwards. While a run
holds the arm, others may read it, change its speed override and recover it; other requests are refused.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import msgspec

from engine.messages import Message, Quaternion, Vector3, Vector6, Wrench
from engine.skill import Capability, Service

ControllerName = Literal["joint_impedance", "cartesian_impedance"]
ArmMode = Literal["disconnected", "fault", "reflex", "idle", "moving", "jogging", "guiding", "direct"]

Share = Annotated[float, msgspec.Meta(ge=0.001, le=1.0, description="Fraction of the programmed speed of motions")]
Damping = Annotated[float, msgspec.Meta(gt=0.0, le=2.0, description="Damping ratio, 1 is critical")]
Mass = Annotated[
    float, msgspec.Meta(ge=0.0, description="Mass of the load of the tool", extra_json_schema={"unit": "kg"})
]
JointRow = tuple[Annotated[float, msgspec.Meta(gt=0.0)], ...]


class ControlSettings(Message, frozen=True, kw_only=True):
    """Control settings, in force until they are changed; they can change at any time without a jump of the arm.

    Stiffness is N m/rad for joints, N/m along and N m/rad about the axes of the arm's base for the tool.
    An empty `joint_stiffness_nm_rad` means the nominal stiffness; an empty `collision_torque_nm` and no
    `collision_force_n` disable the reflex. The tool centre point and the centre of mass of the load are
    given in the model's tool link. `nullspace_stiffness_nm_rad` pulls a redundant arm towards the joints of its
    set point without moving the tool; None is half of the nominal stiffness of each joint. `speed_override`
    is the share of their own speed at which all motions run.
    """

    controller: ControllerName = "joint_impedance"
    joint_stiffness_nm_rad: tuple[float, ...] = ()
    joint_damping_ratio: float = 1.0
    cartesian_stiffness: Vector6 = (3000.0, 3000.0, 3000.0, 200.0, 200.0, 200.0)
    cartesian_damping_ratio: float = 1.0
    nullspace_stiffness_nm_rad: float | None = None
    tool_xyz_m: Vector3 = (0.0, 0.0, 0.0)
    tool_xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)
    load_kg: float = 0.0
    load_com_m: Vector3 = (0.0, 0.0, 0.0)
    collision_torque_nm: tuple[float, ...] = ()
    collision_force_n: float | None = None
    speed_override: float = 1.0


class ArmStatus(Message, frozen=True, kw_only=True):
    """Mode, activity and settings of an arm; the latest value of `<arm>/status`, published at every change of mode.

    `activity` names the active skill, or what a goal waits for. `error` is the reason why the last skill
    failed or the arm stopped by itself; it is empty after a success. `external_nm` and `wrench` are the
    estimated external joint torques and the external wrench on the tool at the time of the message.
    """

    mode: ArmMode
    activity: str = ""
    error: str = ""
    settings: ControlSettings
    external_nm: tuple[float, ...]
    wrench: Wrench


class SpeedOverride(Message, frozen=True, kw_only=True):
    """The fraction of their programmed speed that all motions run at; the latest value of `<arm>/speed_override`."""

    share: float


class ReadArm(Service[ArmStatus], frozen=True, kw_only=True):
    """Return the status of the arm."""


class SetSpeedOverride(Service[ControlSettings], frozen=True, kw_only=True):
    """Run all motions, including the active one, at `share` of their programmed speed; needs no lease."""

    share: Share


class SetController(Service[ControlSettings], frozen=True, kw_only=True):
    """Switch the control law that tracks the set point; the arm does not jump."""

    capability: ClassVar[Capability] = "torque"

    controller: ControllerName


class SetJointImpedance(Service[ControlSettings], frozen=True, kw_only=True):
    """Set the joint stiffness in N m/rad, one value per joint (empty: nominal), and the damping."""

    capability: ClassVar[Capability] = "torque"

    stiffness_nm_rad: JointRow = ()
    damping_ratio: Damping = 1.0


class SetCartesianImpedance(Service[ControlSettings], frozen=True, kw_only=True):
    """Set the stiffness of the tool, N/m along and N m/rad about the axes of the arm's base, and the damping."""

    capability: ClassVar[Capability] = "torque"

    stiffness: Vector6
    damping_ratio: Damping = 1.0
    nullspace_stiffness_nm_rad: Annotated[float, msgspec.Meta(ge=0.0)] | None = None


class SetEndEffectorFrame(Service[ControlSettings], frozen=True, kw_only=True):
    """Set the tool centre point in the model's tool link; Cartesian goals then refer to that point.

    Refused while the arm moves.
    """

    xyz_m: Vector3
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)


class SetLoad(Service[ControlSettings], frozen=True, kw_only=True):
    """Set the load of the tool, so that its weight is compensated; the centre of mass is in the tool link."""

    mass_kg: Mass
    com_m: Vector3 = (0.0, 0.0, 0.0)


class SetCollisionBehavior(Service[ControlSettings], frozen=True, kw_only=True):
    """Set the thresholds of the reflex: external torque of each joint, external force at the tool.

    An empty `torque_nm` and no `force_n` disable the reflex.
    """

    capability: ClassVar[Capability] = "reflex"

    torque_nm: JointRow = ()
    force_n: Annotated[float, msgspec.Meta(gt=0.0)] | None = None


class RecoverFromError(Service[ArmStatus], frozen=True, kw_only=True):
    """Recover from a reflex: the arm holds its position and accepts goals again. Needs no lease; else does nothing."""
