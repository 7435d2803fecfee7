"""Tracks a moving tool pose near a nominal path within the joint limits."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ToolKinematics
from robots.control.force.cholesky import solve_positive_definite
from robots.model.inverse_kinematics import pose_error
from robots.model.robot_model import JointLimits
from robots.model.transform import RigidTransform
from robots.port import Array

_DAMPING = 1e-7
_ACCELERATION_SHARE = 0.95
_VELOCITY_SHARE = 0.98
_STOP_SHARE = 0.8
# The self-motion of a redundant arm returns to the nominal joints at this rate.
_RETURN_HZ = 1.0
_FULL_POSE = 6


class ToolTracker:
    """`position`, `velocity`, `acceleration` (n,) are the joints, reused; `missing_m`, `missing_rad` the pose error.

    Each period makes one damped Newton step from the last solution. Arms of fewer than six
    joints track the tool's position only.
    """

    def __init__(self, *, limits: JointLimits, start: Array) -> None:
        self._lower = np.minimum(limits.lower_rad, start)
        self._upper = np.maximum(limits.upper_rad, start)
        self._fastest = np.array(limits.velocity_rad_s) * _VELOCITY_SHARE
        self._acceleration = np.array(limits.acceleration_rad_s2) * _ACCELERATION_SHARE
        self._rows = _FULL_POSE if len(start) >= _FULL_POSE else 3
        self._damping = _DAMPING * np.eye(self._rows)
        self._nominal = np.array(start, dtype=np.float64)
        self.position = self._nominal.copy()
        self.velocity = np.zeros(len(start))
        self.acceleration = np.zeros(len(start))
        self.missing_m = 0.0
        self.missing_rad = 0.0
        self.hindered = 0
        """The joint whose speed fell shortest of what the pose requires."""

    def step(
        self, step_s: float, *, target: RigidTransform, nominal: Array, kinematics: ToolKinematics, returning: float
    ) -> None:
        """Advance to `target` (world); `nominal` are the joints of the path without deviation.

        `returning` (0 to 1) scales how fast a redundant arm returns to the nominal joints.
        """
        guess = self.position + (nominal - self._nominal)
        self._nominal[:] = nominal
        pose, jacobian = kinematics.tool_pose_and_jacobian(guess)
        error = self._error(pose, target)
        if len(guess) > self._rows and returning > 0.0:
            pull = (_RETURN_HZ * step_s * returning) * (nominal - guess)
            guess = guess + pull
            error = error - jacobian[: self._rows] @ pull
        self._go(step_s, (guess + self._newton(jacobian[: self._rows], error) - self.position) / step_s)

    def brake(self, step_s: float) -> None:
        """Come to rest."""
        self._go(step_s, np.zeros_like(self.velocity))

    def _error(self, pose: RigidTransform, target: RigidTransform) -> Array:
        error = pose_error(pose, target)[: self._rows]
        self.missing_m = float(np.sqrt(error[:3] @ error[:3]))
        if self._rows == _FULL_POSE:
            self.missing_rad = float(np.sqrt(error[3:] @ error[3:]))
        return error

    def _newton(self, jacobian: Array, error: Array) -> Array:
        return jacobian.T @ solve_positive_definite(jacobian @ jacobian.T + self._damping, error)

    def _go(self, step_s: float, requested: Array) -> None:
        change = self._acceleration * step_s
        highest = np.minimum(np.minimum(self.velocity + change, self._fastest), self._stoppable(step_s, self._upper))
        lowest = np.maximum(np.maximum(self.velocity - change, -self._fastest), -self._stoppable(step_s, self._lower))
        velocity = np.minimum(np.maximum(requested, lowest), highest)
        self.hindered = int(np.argmax(np.abs(requested - velocity)))
        self.acceleration[:] = (velocity - self.velocity) / step_s
        self.velocity[:] = velocity
        self.position += velocity * step_s

    def _stoppable(self, step_s: float, limit: Array) -> Array:
        """Return the maximum velocities of this period from which the joints can stop at a limit."""
        hardest = _STOP_SHARE * self._acceleration
        room = np.abs(limit - self.position)
        return hardest * (np.sqrt(step_s * step_s + 2.0 * room / hardest) - step_s)
