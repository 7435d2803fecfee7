"""Kinesthetic guiding: the set point follows the arm guided by hand (RCL 4.1.2)."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.generators.online_trajectory import OnlineTrajectoryGenerator
from robots.control.generators.setpoint_stream import SetpointStream
from robots.model.robot_model import JointLimits
from robots.port import Array


class GuidingGenerator(SetpointStream):
    """The set point is the measured configuration, kept `margin_rad` inside the position limits.

    While `leads` is False the arm floats: its controller compensates gravity, and the spring between
    measured joints and set point is zero inside the range and pushes back near a limit. While
    held, and to finish, the set point leads: it comes to rest from the arm's present position and
    velocity, and stays.

    Args:
        limits: Joint limits.
        start: The arm's set point, at rest, (n,), rad; held before it has followed the arm, it stays there.
        measured: The measured joints, (n,), rad.
        margin_rad: Distance from a limit at which the arm is pushed back.
    """

    name = "guiding"
    """For messages."""

    def __init__(self, *, limits: JointLimits, start: Array, measured: Array, margin_rad: float = 0.03) -> None:
        super().__init__(
            shaper=OnlineTrajectoryGenerator(limits=limits, start=start), values=0, watchdog_s=float("inf")
        )
        self._silence_s = 0.0
        self._lower = np.minimum(np.array(limits.lower_rad) + margin_rad, measured)
        self._upper = np.maximum(np.array(limits.upper_rad) - margin_rad, measured)
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
        """Take no values."""

    def _go(self, step_s: float, *, pace: float, state: ArmState) -> None:
        self._floating = True
        inside = np.minimum(np.maximum(state.position, self._lower), self._upper)
        self._shaper.place(inside, np.where(inside == state.position, state.velocity, 0.0))

    def _rest(self, step_s: float) -> None:
        self._floating = False
        super()._rest(step_s)
