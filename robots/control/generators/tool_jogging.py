"""Tool jogging: the tool moves at a streamed velocity, and the joints follow as well as they can."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.generators.damped_inverse import joint_velocity, twist_rows
from robots.control.generators.online_trajectory import OnlineTrajectoryGenerator
from robots.control.generators.setpoint_stream import SetpointStream
from robots.model.robot_model import JointLimits
from robots.port import Array

_GOING_SHARE = 0.5
_VELOCITY_SHARE = 0.98
# A joint decelerates towards its limit with this share of its acceleration.
_APPROACH_SHARE = 0.5
_SLOW = 1e-9
# Faster twists (m/s, rad/s) are clipped to this speed in the same direction: beyond any arm, and no product overflows.
_FASTEST = 100.0


class ToolJogGenerator(SetpointStream):
    """A stream of velocities of the tool centre point in world axes: m/s, then rad/s, (6,).

    At a joint's speed or position limit all joints slow down equally, so that the
    tool keeps the commanded direction and finally stops. An arm of fewer than six joints
    follows the linear velocity and lets the tool turn; it follows the angular velocity when the linear one
    is zero. The kinematics are those of the `ArmState` of each step.

    Args:
        limits: Joint limits.
        start: The arm's set point, at rest, (n,), rad.
        watchdog_s: Maximum silence before the set point comes to rest.
    """

    name = "tool jog"
    """For messages."""

    def __init__(self, *, limits: JointLimits, start: Array, watchdog_s: float) -> None:
        shaper = OnlineTrajectoryGenerator(limits=limits, start=start, share=_GOING_SHARE)
        super().__init__(shaper=shaper, values=6, watchdog_s=watchdog_s)
        # The twist of the last period and its joint velocities.
        self._twist = np.zeros(0)
        self._whole = np.zeros(len(start))

    def _go(self, step_s: float, *, pace: float, state: ArmState) -> None:
        _, jacobian = state.kinematics.tool_pose_and_jacobian(self.position)
        rows = twist_rows(self._received, len(self.position))
        twist = self._bounded(self._received[rows]) * pace
        velocity = joint_velocity(jacobian[rows], twist)
        share = self._share(velocity)
        same = np.array_equal(twist, self._twist)
        turning = (velocity - self._whole) * (share / step_s) if same else np.zeros_like(velocity)
        self._twist, self._whole = twist, velocity
        self._shaper.run_together(step_s, velocity=velocity * share, turning=turning)

    def _rest(self, step_s: float) -> None:
        super()._rest(step_s)
        self._twist = np.zeros(0)

    @staticmethod
    def _bounded(twist: Array) -> Array:
        fastest = float(np.abs(twist).max())
        return twist if fastest <= _FASTEST else twist / fastest * _FASTEST

    def _share(self, velocity: Array) -> float:
        """Return the share of these velocities that keeps every joint below its speed limit."""
        shaper = self._shaper
        room = np.where(velocity > 0.0, shaper.upper_rad - self.position, self.position - shaper.lower_rad)
        stoppable = np.sqrt(2.0 * _APPROACH_SHARE * shaper.acceleration_rad_s2 * np.maximum(room, 0.0))
        allowed = np.minimum(_VELOCITY_SHARE * shaper.velocity_rad_s, stoppable)
        return min(1.0, float((allowed / np.maximum(np.abs(velocity), _SLOW)).min()))
