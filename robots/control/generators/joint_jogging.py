"""Joint jogging: joints run at streamed velocities and slow down before their limits (RCL 4.3.8)."""

from __future__ import annotations

from robots.control.arm_state import ArmState
from robots.control.generators.online_trajectory import OnlineTrajectoryGenerator
from robots.control.generators.setpoint_stream import SetpointStream
from robots.model.robot_model import JointLimits
from robots.port import Array

_GOING_SHARE = 0.5


class JointJogGenerator(SetpointStream):
    """A stream of joint velocities, (n,), rad/s, clipped to the limits.

    Every joint moves independently and comes to rest at its position limit.

    Args:
        limits: Joint limits.
        start: The arm's set point, at rest, (n,), rad.
        watchdog_s: Maximum silence before the set point comes to rest.
    """

    name = "joint jog"
    """For messages."""

    def __init__(self, *, limits: JointLimits, start: Array, watchdog_s: float) -> None:
        shaper = OnlineTrajectoryGenerator(limits=limits, start=start, share=_GOING_SHARE)
        super().__init__(shaper=shaper, values=len(start), watchdog_s=watchdog_s)

    def _go(self, step_s: float, *, pace: float, state: ArmState) -> None:
        self._shaper.run(step_s, velocity=self._received * pace)
