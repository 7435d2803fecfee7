"""Mass and centre of mass from the wrenches of a wrist sensor in many orientations, by least squares.

Atkeson, An and Hollerbach, Estimation of inertial parameters of manipulator loads and links, IJRR 1986: force and
torque are linear in the mass m and the first moment m c. The offset of the sensor turns with it, so that orientations
tell it from the weight. Rotational inertia is left out: the swings are slow, and `SetLoad` has none.

The wrist sensor is used and not the torques of the joints: 1 % of Coulomb friction are 0.9 N m at a Panda's shoulder,
the weight of 0.2 kg at 0.5 m, and 2 % of the mass of its links another 0.1 kg. A sensor behind the joints feels
neither.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.errors import RobotError
from engine.skills.identification import PayloadEstimate
from robots.arm.identification.least_squares import fit
from robots.port import Array

# A torque of 1 N m counts as much as a force of 10 N: the usual ratio of a sensor's noise.
_TORQUE_WEIGHT_1_M = 10.0
# Independent measurements of a motion: about one a swing.
_INDEPENDENT = 6.0
_LEAST_MASS_KG = 1e-3
# Smallest share of the largest singular value at which mass and offset still are told apart.
_RANK_SHARE = 0.02
_UNCERTAIN = 2.0


@dataclass(frozen=True, kw_only=True)
class WristSamples:
    """Measurements of one motion in the axes of the tool link: k samples.

    `force_n` and `torque_nm` (k, 3) are exerted on the tool, the torque about the origin of the link; `falling_m_s2`
    (k, 3) is gravity minus the acceleration of that origin.
    """

    force_n: Array
    torque_nm: Array
    falling_m_s2: Array


def estimate_payload(samples: WristSamples, *, set_kg: float, set_com_m: tuple[float, float, float]) -> PayloadEstimate:
    """Return the payload whose wrench these are, added to the load that is set and so not measured.

    Raises:
        RobotError: the orientations differ too little to tell the weight from the offset of the sensor.
    """
    count = len(samples.force_n)
    rows = np.zeros((count, 6, 10))
    rows[:, :3, 0] = samples.falling_m_s2
    rows[:, 3:, 1:4] = -_TORQUE_WEIGHT_1_M * _cross_matrices(samples.falling_m_s2)
    rows[:, :3, 4:7] = np.eye(3)
    rows[:, 3:, 7:] = _TORQUE_WEIGHT_1_M * np.eye(3)
    matrix = rows.reshape(-1, 10)
    measured = np.hstack((samples.force_n, _TORQUE_WEIGHT_1_M * samples.torque_nm)).reshape(-1)
    found = fit(matrix, measured, independent=6.0 * _INDEPENDENT, least_share=_RANK_SHARE)
    if found is None:
        raise RobotError(
            "the tool was tilted too little to tell the weight from the offset of the wrist sensor",
            hint="give a larger amplitude_rad, or a configuration in which the last joints tilt the tool",
        )
    left, deviation = found.residual.reshape(count, 6), found.deviation
    mass_kg = max(0.0, float(found.solution[0]) + set_kg)
    moment: Array = found.solution[1:4] + set_kg * np.array(set_com_m)
    x, y, z = (float(value) / mass_kg if mass_kg > _LEAST_MASS_KG else 0.0 for value in moment)
    return PayloadEstimate(
        mass_kg=mass_kg,
        com_m=(x, y, z),
        mass_uncertainty_kg=_UNCERTAIN * float(deviation[0]),
        com_uncertainty_m=_UNCERTAIN * float(deviation[1:4].max()) / max(mass_kg, _LEAST_MASS_KG),
        residual_n=float(np.sqrt(np.mean(left[:, :3] ** 2))),
        residual_nm=float(np.sqrt(np.mean(left[:, 3:] ** 2))) / _TORQUE_WEIGHT_1_M,
        samples=count,
    )


def _cross_matrices(vectors: Array) -> Array:
    """Return [v]× of each row, (k, 3, 3)."""
    matrices = np.zeros((len(vectors), 3, 3))
    for row, column, axis, sign in (
        (0, 1, 2, -1),
        (0, 2, 1, 1),
        (1, 0, 2, 1),
        (1, 2, 0, -1),
        (2, 0, 1, -1),
        (2, 1, 0, 1),
    ):
        matrices[:, row, column] = sign * vectors[:, axis]
    return matrices
