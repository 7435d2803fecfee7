"""Kinesthetic guiding: the set point follows the arm that is led by hand (RCL 4.1.2)."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.online_trajectory import OnlineTrajectoryGenerator
from robots.control.setpoint_stream import SetpointStream
from robots.model.robot_model import JointLimits
from robots.port import Array


class GuidingGenerator(SetpointStream):
    """The set point is the measured arm, kept `margin_rad` inside the position limits.

    While `leads` is False the arm is to float: its controller compensates gravity and leaves a spring
    from the measured joints to the set point, which is nothing inside and pushes back near a
    limit. While it is held, and to finish, it leads: it comes to rest from where and how fast the arm
    is, and stays.

    Args:
        limits: Of the joints.
        start: The measured joints, (n,), rad.
        margin_rad: How far before a limit the arm is pushed back.
    """

    def __init__(self, *, limits: JointLimits, start: Array, margin_rad: float = 0.03) -> None:
        super().__init__(
            shaper=OnlineTrajectoryGenerator(limits=limits, start=start), values=0, watchdog_s=float("inf")
        )
        self._silence_s = 0.0
        self._lower = np.minimum(np.array(limits.lower_rad) + margin_rad, start)
        self._upper = np.maximum(np.array(limits.upper_rad) - margin_rad, start)
        self._floating = True

    @property
    def leads(self) -> bool:
        """False while the arm floats."""
        return not self._floating

    @property
    def stopped(self) -> bool:
        """True when it does not float and the set point stands still."""
        return not self._floating and super().stopped

    def receive(self, values: Array, *, age_s: float = 0.0) -> None:
        """Nothing is told to it."""

    def _go(self, step_s: float, *, pace: float, state: ArmState) -> None:
        self._floating = True
        inside = np.minimum(np.maximum(state.position, self._lower), self._upper)
        self._shaper.place(inside, np.where(inside == state.position, state.velocity, 0.0))

    def _rest(self, step_s: float) -> None:
        self._floating = False
        super()._rest(step_s)
