"""Cartesian impedance: springs and dampers between the tool and its set point (RCY 4.4, eq. 2)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from engine.skills.arm_control import ControlSettings
from robots.control.arm_state import ArmState
from robots.control.laws.controller import SetPoint
from robots.control.laws.joint_impedance import nominal_stiffness_nm_rad
from robots.model.robot_model import JointLimits
from robots.port import Array

# The inertia of a tool direction is limited to this multiple of the mean: near a singularity it stays
# bounded, and the null space takes the direction over.
_LIGHTEST_SHARE = 0.03
# Joint damping assumes at least this null-space stiffness, so that the joints never drift freely.
_LEAST_STIFFNESS_NM_RAD = 2.0
# Default of the null space, share of the nominal stiffness of each joint: friction of 5 % of the limit, that of a worn
# arm, then holds a joint 6 mrad beside its set point.
_NULLSPACE_SHARE = 0.5


class CartesianImpedance:
    """Implements `Controller`: τ = clip(Jᵀ (K e + D ė) + Nᵀ (K_n (q_d − q) + D_n (q̇_d − q̇)) + feedforward).

    e is the pose of the set point minus the measured one, translation and rotation vector, in the
    axes of the arm's base; K is `cartesian_stiffness` and D `cartesian_damping_ratio` times
    critical, axis by axis, for the present tool inertia Λ = (J M⁻¹ Jᵀ)⁻¹. N is the
    dynamically consistent null space I − M⁻¹ Jᵀ Λ J: its joint torques do not move the
    tool. J is not inverted, so torques stay bounded at singularities.

    Args:
        limits: Joint limits.
        mass_matrix: Returns M, (n, n), for joints of shape (n,).
        base_rotation: Axes of the base in the world, (3, 3).
    """

    def __init__(self, limits: JointLimits, *, mass_matrix: Callable[[Array], Array], base_rotation: Array) -> None:
        from robots.control import kernels

        self._hang_tool, self._pose_error = kernels.impedance_torque, kernels.pose_error
        self._upper_nm = np.array(limits.effort_nm)
        self._lower_nm = -self._upper_nm
        self._mass_matrix = mass_matrix
        self._base_rotation = np.array(base_rotation, dtype=np.float64)
        self._error = np.zeros(6)
        self._joint_error = np.zeros_like(self._upper_nm)
        self._joint_error_rate = np.zeros_like(self._upper_nm)
        self._torque = np.zeros_like(self._upper_nm)
        self._stiffness = np.zeros(6)
        self._damping_root = np.zeros(6)
        self._nullspace_nm_rad = _NULLSPACE_SHARE * nominal_stiffness_nm_rad(limits)
        self._joint_stiffness = self._nullspace_nm_rad
        self._joint_damping_root = np.zeros_like(self._upper_nm)

    def initialize(self, *, settings: ControlSettings, inertia_kg_m2: Array) -> None:
        """Take stiffness and damping ratio; every step recomputes the inertia."""
        ratio = settings.cartesian_damping_ratio
        self._stiffness = np.array(settings.cartesian_stiffness)
        self._damping_root = 2.0 * ratio * np.sqrt(self._stiffness)
        given = settings.nullspace_stiffness_nm_rad
        nominal = self._nullspace_nm_rad
        self._joint_stiffness = nominal if given is None else np.full_like(nominal, given)
        least = np.minimum(_LEAST_STIFFNESS_NM_RAD, nominal)
        self._joint_damping_root = 2.0 * ratio * np.sqrt(np.maximum(self._joint_stiffness, least))

    def step(self, state: ArmState, set_point: SetPoint, *, feedforward_nm: Array) -> Array:
        """Return the joint torques, within the limits; the array is reused by the next call.

        Raises:
            ArithmeticError: the mass matrix is not positive definite.
        """
        torque = self._torque
        measured, target = state.tool, state.kinematics.tool_pose(set_point.position)
        self._pose_error(target.xyz, target.xyzw, measured.xyz, measured.xyzw, self._error)
        np.subtract(set_point.position, state.position, out=self._joint_error)
        np.subtract(set_point.velocity, state.velocity, out=self._joint_error_rate)
        done = self._hang_tool(
            state.jacobian,
            self._base_rotation,
            self._mass_matrix(state.position),
            self._error,
            self._joint_error,
            self._joint_error_rate,
            self._stiffness,
            self._damping_root,
            self._joint_stiffness,
            self._joint_damping_root,
            _LIGHTEST_SHARE,
            torque,
        )
        if not done:
            raise ArithmeticError("the mass matrix of an arm is not positive definite")
        torque += feedforward_nm
        np.minimum(torque, self._upper_nm, out=torque)
        np.maximum(torque, self._lower_nm, out=torque)
        return torque

    def terminate(self) -> Array:
        """Return the final torques: zero."""
        self._torque[:] = 0.0
        return self._torque
