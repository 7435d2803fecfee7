"""Settings of an arm: controller, stiffness, tool, load, thresholds."""

from __future__ import annotations

from typing import Literal

import msgspec

from engine.messages import Quaternion, Vector3

Vector6 = tuple[float, float, float, float, float, float]
ControllerName = Literal["joint_impedance", "cartesian_impedance"]
NO_FRAME: tuple[Vector3, Quaternion] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


class ArmSettings(msgspec.Struct, frozen=True, kw_only=True):
    """Settings that stay active until changed; they can change at any time without a jump of the arm.

    Attributes:
        controller: The control law that holds the set point.
        joint_stiffness_nm_rad: One value per joint; empty for the model's nominal ones.
        joint_damping_ratio: One value for all joints, 1 is critical.
        cartesian_stiffness: N/m along and N m/rad about the axes of the tool's base frame (x y z, then rotations).
        cartesian_damping_ratio: 1 is critical.
        nullspace_stiffness_nm_rad: Pulls a redundant arm towards the joints of its set point without moving
            the tool.
        tool_xyz_m, tool_xyzw: The tool centre point in the frame of the model's tool link.
        load_kg, load_com_m: Mass of the load and its centre of mass in the model's tool link.
        collision_torque_nm: External joint torque that trips the reflex, one value per joint; empty for never.
        collision_force_n: External force at the tool that trips the reflex; None for never.
        speed_override: Share of the nominal speed at which all motions run, 0.001 to 1.
    """

    controller: ControllerName = "joint_impedance"
    joint_stiffness_nm_rad: tuple[float, ...] = ()
    joint_damping_ratio: float = 1.0
    cartesian_stiffness: Vector6 = (3000.0, 3000.0, 3000.0, 200.0, 200.0, 200.0)
    cartesian_damping_ratio: float = 1.0
    nullspace_stiffness_nm_rad: float = 20.0
    tool_xyz_m: Vector3 = NO_FRAME[0]
    tool_xyzw: Quaternion = NO_FRAME[1]
    load_kg: float = 0.0
    load_com_m: Vector3 = (0.0, 0.0, 0.0)
    collision_torque_nm: tuple[float, ...] = ()
    collision_force_n: float | None = None
    speed_override: float = 1.0
