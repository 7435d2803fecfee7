"""The external joint torques of an arm, estimated from its momentum, its commanded torques and its nominal model."""

from __future__ import annotations

import math

import numpy as np

from robots.port import Array

OBSERVER_GAIN_1_S = 2.0 * math.pi * 60.0
"""Gain K of the observer: a step of the external torque is estimated to 63 % after 1/K = 2.7 ms, to 98 % after 10 ms.

A larger gain is faster and passes more noise: that of the velocities enters multiplied by K and the inertia of a joint.
"""


class MomentumObserver:
    """The generalized-momentum observer of De Luca et al. (IROS 2006); Haddadin, De Luca, Albu-Schäffer (T-RO 2017).

    With the momentum p = M(q) q̇ the residual is r = K (p − ∫ (τ + Cᵀ q̇ − g + r) dt): the external torque behind a
    first-order low-pass filter of gain K, in which no acceleration occurs.

    Ṁ = C + Cᵀ, so in a period from k to k+1 the part of the change of p that is not due to torques is
    (M(k+1) − M(k)) q̇(k+1), and what remains is M(k) (q̇(k+1) − q̇(k)). Sampled this way, the residual of an arm that
    matches its model is zero in every motion, also when the period is long; no Coriolis matrix is needed.

    What the model lacks is estimated as an external torque too: friction, errors of masses, and the delay of motors.

    Args:
        dof: Number of joints n.
        gain_1_s: K.
    """

    def __init__(self, dof: int, *, gain_1_s: float = OBSERVER_GAIN_1_S) -> None:
        from robots.control import kernels

        self._observe = kernels.observe_momentum
        self.external_nm: Array = np.zeros(dof)
        """The estimate, (n,); always the same array."""
        self._gain_1_s = gain_1_s
        self._velocity = np.zeros(dof)
        self._mass = np.zeros((dof, dof))
        self._known_nm = np.zeros(dof)
        self._commanded = False

    def forget(self) -> None:
        """Start from zero: the arm was moved elsewhere."""
        self.external_nm[:] = 0.0
        self._commanded = False

    def command(self, torque_nm: Array, *, velocity: Array, mass_matrix: Array, bias_nm: Array) -> None:
        """Take the torques of the period that begins.

        Args:
            torque_nm: The commanded torques τ, (n,).
            velocity: Measured joint velocities, (n,), rad/s.
            mass_matrix: M of the nominal model at the measured joints, (n, n), kg m²; kept, not copied.
            bias_nm: C q̇ + g of the nominal model there, (n,), with all dampers that it knows.
        """
        self._velocity[:] = velocity
        self._mass = mass_matrix
        np.subtract(torque_nm, bias_nm, out=self._known_nm)
        self._commanded = True

    def measure(self, velocity: Array, *, load_nm: Array | None, step_s: float) -> None:
        """Update the estimate at the end of a period.

        Args:
            velocity: Measured joint velocities, (n,), rad/s.
            load_nm: Torques that a load exerts that the nominal model lacks and the arm knows of, (n,).
            step_s: Duration of the period.
        """
        if not self._commanded:
            return
        if load_nm is not None:
            self._known_nm += load_nm
        share = 1.0 - math.exp(-self._gain_1_s * step_s)
        self._observe(self._mass, self._velocity, velocity, self._known_nm, step_s, share, self.external_nm)
        self._commanded = False
