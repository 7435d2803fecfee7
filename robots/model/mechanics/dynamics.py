"""Dynamics of one arm with its tool and a load: mass matrix, Coriolis and centrifugal torque, gravity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from robots.model.mechanics.pinocchio_model import arm_model, pin
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform
from robots.port import Array

GRAVITY_M_S2 = 9.81
_DOWN_M_S2 = (0.0, 0.0, -GRAVITY_M_S2)


@dataclass(frozen=True, kw_only=True)
class Payload:
    """A payload: mass, centre of mass in the frame of the tool centre point, inertia about it.

    `inertia_kg_m2` is the diagonal about the axes of that frame; a point mass by default.
    """

    mass_kg: float
    com_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    inertia_kg_m2: tuple[float, float, float] = (0.0, 0.0, 0.0)


class ArmDynamics:
    """Torques at the arm joints, shapes (n,) and (n, n), of the nominal model; the tool's joints are locked at 0.

    M(q) q̈ + c(q, q̇) + g(q) = τ, with the motors' inertia at the joints in M unless `motors` is
    False. One instance serves one thread at a time.

    Args:
        model: The arm.
        base: Pose of its base link in the world, whose z is up.
        load: The payload.
        gravity_m_s2: Gravity in the world, (3,).
        motors: Include `RobotModel.armature_kg_m2`.
    """

    def __init__(
        self,
        model: RobotModel,
        *,
        base: RigidTransform | None = None,
        load: Payload | None = None,
        motors: bool = True,
        gravity_m_s2: Array | None = None,
    ) -> None:
        self.model = model
        self._solver = solver = arm_model(model)
        gravity = np.array(_DOWN_M_S2) if gravity_m_s2 is None else gravity_m_s2
        solver.gravity.linear = base.rotation.T @ gravity if base is not None else gravity
        solver.armature = np.array(model.armature_kg_m2) if motors else np.zeros(model.dof)
        if load is not None:
            _carry(solver, model.tool_link, load)
        self._data = solver.createData()
        self.damping_nms_rad: Array = np.array(solver.damping)
        """Dampers at the joints, (n,), as described in the URDF; not in `bias`."""

    def mass_matrix(self, joints: Array) -> Array:
        """Return M(q), symmetric, in kg m²."""
        return pin.crba(self._solver, self._data, joints)

    def bias(self, joints: Array, velocity: Array) -> Array:
        """Return c(q, q̇) + g(q): the torque for constant velocity, in N m."""
        return pin.nonLinearEffects(self._solver, self._data, joints, velocity)

    def gravity(self, joints: Array) -> Array:
        """Return g(q), in N m."""
        return pin.computeGeneralizedGravity(self._solver, self._data, joints).copy()

    def torque(self, joints: Array, velocity: Array, acceleration: Array) -> Array:
        """Return the torques for this acceleration, in N m."""
        return pin.rnea(self._solver, self._data, joints, velocity, acceleration).copy()


def _carry(solver: Any, tool_link: str, load: Payload) -> None:
    frame = solver.frames[solver.getFrameId(tool_link)]
    body = pin.Inertia(load.mass_kg, np.array(load.com_m), np.diag(load.inertia_kg_m2))
    solver.appendBodyToJoint(frame.parentJoint, body, frame.placement)
