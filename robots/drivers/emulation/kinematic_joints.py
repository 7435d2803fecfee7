"""Joints without physics: they are where they are commanded."""

from __future__ import annotations

import numpy as np

from robots.port import Array


class KinematicJoints:
    """Implements `ArmPlant`; starts at `position_rad`."""

    problem = ""

    def __init__(self, position_rad: Array) -> None:
        self._measured = (position_rad, np.zeros(len(position_rad)))

    def follow(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Be there."""
        self._measured = (position_rad, velocity_rad_s)

    def carry(self, mass_kg: float) -> None:
        """Weigh nothing."""

    def measured(self) -> tuple[Array, Array]:
        """Return the latest set point."""
        return self._measured

    def reset(self) -> None:
        """There is no problem."""
