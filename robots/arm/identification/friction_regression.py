"""Coulomb and viscous friction of one joint from its motor torques on a swing, by least squares.

The torque beyond the nominal model is τ_c sign(v) + τ_v v and what the model has wrong: the weight, which depends on
the position, and the inertia. A swing passes each position both ways, so that these are told from friction (Kermani,
Patel and Moallem, Friction identification and compensation in robotic manipulators, TIM 2007).
"""

from __future__ import annotations

import numpy as np

from engine.skills.identification import JointFrictionEstimate
from robots.arm.identification.least_squares import fit
from robots.port import Array

_LEAST_SAMPLES = 50
# Slower samples are left out: the sign of the velocity is not sure, and joints may stick.
_SLOW_RAD_S = 0.03
# Independent measurements of a motion: two swings have so many passages.
_INDEPENDENT = 8.0
_UNCERTAIN = 2.0


def moves(velocity_rad_s: Array) -> bool:
    """Return whether a joint moved for long enough, given its velocity at each sample."""
    return int((np.abs(velocity_rad_s) > _SLOW_RAD_S).sum()) >= _LEAST_SAMPLES


def estimate_friction(
    joint: str, *, excess_nm: Array, position_rad: Array, velocity_rad_s: Array, acceleration_rad_s2: Array
) -> JointFrictionEstimate:
    """Return the friction of a joint; all arrays (k,), of samples in which only this joint moved.

    Args:
        joint: Its name.
        excess_nm: Motor torque beyond that of the nominal model without friction.
        position_rad: Its position.
        velocity_rad_s: Its velocity.
        acceleration_rad_s2: Its acceleration.
    """
    used = np.abs(velocity_rad_s) > _SLOW_RAD_S
    velocity, acceleration = velocity_rad_s[used], acceleration_rad_s2[used]
    aside = position_rad[used] - float(np.mean(position_rad[used]))
    matrix = np.column_stack((np.sign(velocity), velocity, np.ones_like(aside), aside, aside**2, acceleration))
    found = fit(matrix, excess_nm[used], independent=_INDEPENDENT)
    # A swing has positions, velocities and accelerations of its own.
    assert found is not None
    solution, deviation = found.solution, found.deviation
    return JointFrictionEstimate(
        joint=joint,
        coulomb_nm=max(0.0, float(solution[0])),
        viscous_nms_rad=max(0.0, float(solution[1])),
        coulomb_uncertainty_nm=_UNCERTAIN * float(deviation[0]),
        viscous_uncertainty_nms_rad=_UNCERTAIN * float(deviation[1]),
        residual_nm=float(np.sqrt(np.mean(found.residual**2))),
    )
