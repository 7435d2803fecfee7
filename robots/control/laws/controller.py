"""The controller interface: torques that hold an arm at its set point, computed every control period (RCY 4.4)."""

from __future__ import annotations

from typing import Protocol

from engine.skills.arm_control import ControlSettings
from robots.control.arm_state import ArmState
from robots.port import Array


class SetPoint(Protocol):
    """The present set point of the arm; shapes (n,)."""

    @property
    def position(self) -> Array:
        """Joints, rad."""
        ...

    @property
    def velocity(self) -> Array:
        """rad/s."""
        ...

    @property
    def acceleration(self) -> Array:
        """rad/s²."""
        ...


class Controller(Protocol):
    """One control law: `initialize` once, `step` at every control period, `terminate` at the end."""

    def initialize(self, *, settings: ControlSettings, inertia_kg_m2: Array) -> None:
        """Take stiffness and damping from `settings`; also called again when these change.

        `inertia_kg_m2` is the diagonal of the arm's mass matrix now, (n,).
        """
        ...

    def step(self, state: ArmState, set_point: SetPoint, *, feedforward_nm: Array) -> Array:
        """Return the joint torques, (n,), within the limits; the array is reused by the next call.

        `feedforward_nm` is gravity, Coriolis and load at the measured state plus the inertia along the set point.
        """
        ...

    def terminate(self) -> Array:
        """Return the final torques: zero."""
        ...
