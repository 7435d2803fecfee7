"""Tracks a moving tool pose near a nominal path within the joint limits."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ToolKinematics
from robots.control.force.cholesky import solve_positive_definite
from robots.control.generators.online_trajectory import OnlineTrajectoryGenerator
from robots.model.inverse_kinematics import pose_error
from robots.model.robot_model import JointLimits
from robots.model.transform import RigidTransform
from robots.port import Array

_DAMPING = 1e-7
_ACCELERATION_SHARE = 0.9
# Joints at rest start again at this multiple of the speed below which they come to rest.
_LEAVES = 3.0
# Speed at which an error of position is corrected, per radian.
_CORRECTION_HZ = 60.0
# The self-motion of a redundant arm returns to the nominal joints at this rate.
_RETURN_HZ = 1.0
_FULL_POSE = 6


class ToolTracker:
    """`position`, `velocity`, `acceleration` (n,) are the joints, reused; `missing_m`, `missing_rad` the pose error.

    Each period makes one damped Newton step from the last solution, and the joints follow it within their limits of
    position, speed, acceleration and jerk. Arms of fewer than six joints track the tool's position only.
    """

    def __init__(self, *, limits: JointLimits, start: Array) -> None:
        self._shaper = OnlineTrajectoryGenerator(limits=limits, start=start, share=_ACCELERATION_SHARE)
        self._rows = _FULL_POSE if len(start) >= _FULL_POSE else 3
        self._damping = _DAMPING * np.eye(self._rows)
        self._nominal = np.array(start, dtype=np.float64)
        self.position = self._shaper.position
        self.velocity = self._shaper.velocity
        self.acceleration = self._shaper.acceleration
        # Where the joints should be, how fast, and how that changes.
        self._target = self._nominal.copy()
        self._rate = np.zeros(len(start))
        self.missing_m = 0.0
        self.missing_rad = 0.0
        self.hindered = 0
        """The joint whose speed fell shortest of what the pose requires."""

    def step(
        self,
        step_s: float,
        *,
        target: RigidTransform,
        nominal: Array,
        kinematics: ToolKinematics,
        returning: float,
        least_rad_s: float,
    ) -> None:
        """Advance to `target` (world); `nominal` are the joints of the path without deviation.

        `returning` (0 to 1) scales how fast a redundant arm returns to the nominal joints. Where no joint needs more
        than `least_rad_s`, they come to rest exactly.
        """
        guess = self.position + (nominal - self._nominal)
        self._nominal[:] = nominal
        pose, jacobian = kinematics.tool_pose_and_jacobian(guess)
        error = self._error(pose, target)
        if len(guess) > self._rows and returning > 0.0:
            pull = (_RETURN_HZ * step_s * returning) * (nominal - guess)
            guess = guess + pull
            error = error - jacobian[: self._rows] @ pull
        self._go(step_s, guess + self._newton(jacobian[: self._rows], error), least_rad_s)

    @property
    def at_rest(self) -> bool:
        """True when the joints stand still."""
        return self._shaper.at_rest

    def brake(self, step_s: float) -> None:
        """Come to rest."""
        self._shaper.brake(step_s)
        self._target[:] = self.position
        self._rate[:] = self.velocity

    def _error(self, pose: RigidTransform, target: RigidTransform) -> Array:
        error = pose_error(pose, target)[: self._rows]
        self.missing_m = float(np.sqrt(error[:3] @ error[:3]))
        if self._rows == _FULL_POSE:
            self.missing_rad = float(np.sqrt(error[3:] @ error[3:]))
        return error

    def _newton(self, jacobian: Array, error: Array) -> Array:
        return jacobian.T @ solve_positive_definite(jacobian @ jacobian.T + self._damping, error)

    def _go(self, step_s: float, target: Array, least_rad_s: float) -> None:
        rate = (target - self._target) / step_s
        rise = (rate - self._rate) / step_s
        self._target, self._rate = target, rate
        if self._comes_to_rest(least_rad_s):
            self._shaper.brake(step_s)
            return
        self._shaper.track(step_s, position=target, velocity=rate, acceleration=rise, pace=1.0)
        self.hindered = int(np.argmax(np.abs(target - self.position)))

    def _comes_to_rest(self, least_rad_s: float) -> bool:
        if least_rad_s == 0.0:
            return False
        needed = float((np.abs(self._rate) + _CORRECTION_HZ * np.abs(self._target - self.position)).max())
        if self.at_rest:
            return needed < _LEAVES * least_rad_s
        return max(needed, float(np.abs(self.velocity).max())) < least_rad_s
