"""How fast a tool may meet a surface, from the force that is wanted at most.

The force at the first touch of something hard rises within milliseconds, before any controller can react; it is
that of the mass that the tool seems to have, m, on the stiffness of the contact, k: v √(m k) for the speed v. So it
can only be limited by the speed. What compensates the friction of the joints pushes on at the touch, as the friction
itself ends with the motion: this force does not depend on the speed, and comes on top.

- Khatib, Inertial properties in robotic manipulation: an object-level framework, IJRR 14(1), 1995: effective mass.
- Haddadin, Albu-Schäffer, Hirzinger, Requirements for safe robots: measurements, analysis and new insights,
  IJRR 28(11-12), 2009: impacts end before collision detection reacts.
- ISO/TS 15066:2016, annex A: permitted speed from force, effective mass and stiffness.
"""

from __future__ import annotations

import math

import numpy as np

from robots.model.mechanics.dynamics import ArmDynamics
from robots.model.mechanics.kinematics import ArmKinematics
from robots.port import Array

# Along a direction in which no joint can move the tool, its mass is finite too.
_LEAST_MOBILITY_1_KG = 1e-6


def effective_mass_kg(dynamics: ArmDynamics, kinematics: ArmKinematics, joints: Array, direction: Array) -> float:
    """Return the mass that resists a push at the tool along `direction`, a unit vector in the world, (3,)."""
    upper = np.triu(dynamics.mass_matrix(joints))
    mass = upper + np.triu(upper, 1).T
    push_nm = kinematics.tool_pose_and_jacobian(joints)[1][:3].T @ direction
    mobility = float(push_nm @ np.linalg.solve(mass, push_nm))
    return 1.0 / max(mobility, _LEAST_MOBILITY_1_KG)


def friction_push_n(kinematics: ArmKinematics, joints: Array, direction: Array) -> float:
    """Return the force along `direction` that compensated friction exerts: its power on a line over the speed.

    The line keeps the orientation of the tool; the power is that of the nominal Coulomb friction of the joints.
    """
    twist = np.concatenate((direction, np.zeros(3)))
    jacobian = kinematics.tool_pose_and_jacobian(joints)[1]
    rates = np.linalg.lstsq(jacobian, twist, rcond=None)[0]
    return float(np.array(kinematics.model.friction.coulomb_nm) @ np.abs(rates))


def touch_speed_m_s(mass_kg: float, *, peak_n: float, surface_n_m: float, friction_n: float = 0.0) -> float:
    """Return the speed at which this mass presses on a contact of this stiffness with at most `peak_n`.

    Args:
        mass_kg: Effective mass.
        peak_n: Greatest force that is wanted.
        surface_n_m: Stiffness of the contact.
        friction_n: Of that force, what compensated friction exerts; less than `peak_n`.
    """
    return (peak_n - friction_n) / math.sqrt(mass_kg * surface_n_m)
