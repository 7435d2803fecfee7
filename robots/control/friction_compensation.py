"""The torques that a controller adds for the nominal friction of the joints, in motion and at rest."""

from __future__ import annotations

import numpy as np

from robots.model.robot_model import JointFriction
from robots.port import Array

SMOOTH_RAD_S = 0.02
"""Speed at which tanh v/v_s reaches 76 % of the Coulomb friction: above the noise of measured velocities."""
SET_POINT_SMOOTH_RAD_S = 0.002
"""The same for the set point, which has no noise: what a joint still has to go when friction is compensated no more is
less than it could be held back by."""

# Share of the nominal friction that is compensated for a hand: a joint with half of it does not go on by itself.
_GUIDING_SHARE = 0.5
# Of the torque that the springs carry at rest, this share a second is taken over. The null space of a Panda swings
# with 15 rad/s and more, so that the integral adds little phase.
_INTEGRAL_1_S = 2.0
# Springs that carry less than this share of the Coulomb friction are left to: integrating through stiction without a
# dead band ends in hunting.
_DEAD_BAND_SHARE = 0.3
# The integral fades with this time constant while the set point moves: the friction then follows the velocity.
_FADE_S = 0.05


class FrictionCompensation:
    """Coulomb and viscous friction along a velocity, and at rest an integral of what the springs of a law carry.

    In motion the torque is τ_c tanh(v / v_s) + τ_v v for the velocity of the set point, until just before its end: an
    arm that loses it earlier sticks behind its goal. It is feed-forward, which cannot
    make an arm unstable (Armstrong-Hélouvry, Dupont, Canudas de Wit, A survey of models, analysis tools and
    compensation methods for the control of machines with friction, Automatica 1994, section 5). At rest friction may
    have either sign. Integral action then takes over the torque of the springs, within ± τ_c so that it cannot wind up
    against a contact by more than friction could hold anyway, and with a dead band against hunting (ibid., section 4).

    Args:
        friction: The nominal friction of the arm.
    """

    def __init__(self, friction: JointFriction) -> None:
        self._coulomb_nm = np.array(friction.coulomb_nm)
        self._viscous_nms_rad = np.array(friction.viscous_nms_rad)
        self._dead_nm = _DEAD_BAND_SHARE * self._coulomb_nm
        self._integral_nm = np.zeros_like(self._coulomb_nm)
        self._spring_nm = np.zeros_like(self._coulomb_nm)

    @property
    def is_settling(self) -> bool:
        """Whether the springs carry more than they are left to, and the integral may still take over more of it."""
        taken_nm = np.sign(self._spring_nm) * self._integral_nm
        return bool(((np.abs(self._spring_nm) > self._dead_nm) & (taken_nm < self._coulomb_nm)).any())

    @property
    def integral_nm(self) -> Array:
        """The torques taken over from the springs, (n,)."""
        return self._integral_nm

    def forget(self) -> None:
        """Start from zero."""
        self._integral_nm[:] = 0.0
        self._spring_nm = np.zeros_like(self._coulomb_nm)

    def along(self, velocity: Array) -> Array:
        """Return the nominal friction of a measured velocity, (n,), in its direction."""
        return self._coulomb_nm * np.tanh(velocity / SMOOTH_RAD_S) + self._viscous_nms_rad * velocity

    def ahead(self, velocity: Array) -> Array:
        """Return the nominal friction of the velocity of a set point, (n,), in its direction."""
        return self._coulomb_nm * np.tanh(velocity / SET_POINT_SMOOTH_RAD_S) + self._viscous_nms_rad * velocity

    def helping(self, velocity: Array, *, pushed_nm: Array) -> Array:
        """Return what helps a hand against the friction of a guided arm, (n,).

        It acts along the measured velocity where the hand pushes that way too, at most as much as the hand: without a
        hand all of the friction brakes the arm, and holds it against an error of its weight.

        Args:
            velocity: Measured joint velocities, (n,).
            pushed_nm: Joint torques of the measured wrench at the tool, (n,).
        """
        share = _GUIDING_SHARE * np.abs(self.along(velocity))
        helped = np.sign(velocity) * np.minimum(share, np.abs(pushed_nm))
        return np.where(velocity * pushed_nm > 0.0, helped, 0.0)

    def integrate(self, spring_nm: Array, *, velocity: Array, step_s: float) -> Array:
        """Return the integral after a period, (n,).

        Args:
            spring_nm: What the law adds to the feedforward, (n,).
            velocity: The velocity of the set point, (n,).
            step_s: Duration of the period.
        """
        integral, limit = self._integral_nm, self._coulomb_nm
        self._spring_nm = spring_nm
        if velocity.any():
            integral *= max(0.0, 1.0 - step_s / _FADE_S)
            return integral
        beyond = np.where(np.abs(spring_nm) > self._dead_nm, spring_nm, 0.0)
        integral += _INTEGRAL_1_S * step_s * beyond
        np.minimum(integral, limit, out=integral)
        np.maximum(integral, -limit, out=integral)
        return integral
