"""How a person's arm gives way: pushed off its motion by contacts, it returns with a limited force."""

from __future__ import annotations

import math

import numpy as np

from robots.port import Array
from robots.sim.physics.person_spec import LIMB_KG

GREATEST_PUSH_N = 140.0
"""Greatest force with which an arm returns to its motion: the quasi-static limit of ISO/TS 15066 for hands."""

YIELDING_FIELDS = 6
"""Length of the complete state."""

# Natural frequency of the return: an arm that is held lightly, critically damped.
_RETURN_RAD_S = 10.0
_STIFFNESS_N_M = LIMB_KG * _RETURN_RAD_S**2
_DAMPING_NS_M = 2.0 * LIMB_KG * _RETURN_RAD_S
# Below both of these an arm that nothing touches is where it should be.
_BACK_M, _BACK_M_S = 1e-4, 1e-3
NO_PUSH_M_S = 1e-9
"""Rounding of the velocities of an arm that nothing touches."""


class Yielding:
    """The displacement of one person's arm from its motion, as a whole: a person leans back or steps aside.

    A mass of `LIMB_KG` receives the impulses of all contacts. `offset` and `velocity` are (3,), world.
    """

    def __init__(self) -> None:
        self.offset = np.zeros(3)
        self.velocity = np.zeros(3)
        self.active = False
        """Whether the arm is displaced or moves relative to its motion."""

    def step(self, pushed: Array, *, step_s: float) -> None:
        """Advance by a step in which contacts changed the velocities of the bodies by `pushed` (3, 3), m/s."""
        push = pushed.sum(axis=0)
        touched = math.hypot(*push.tolist()) > NO_PUSH_M_S
        if not touched and not self.active:
            return
        force = -_STIFFNESS_N_M * self.offset - _DAMPING_NS_M * self.velocity
        size = math.hypot(*force.tolist())
        if size > GREATEST_PUSH_N:
            force *= GREATEST_PUSH_N / size
        self.velocity += push + force * (step_s / LIMB_KG)
        self.offset += self.velocity * step_s
        is_back = math.hypot(*self.offset.tolist()) < _BACK_M and math.hypot(*self.velocity.tolist()) < _BACK_M_S
        self.active = touched or not is_back
        if not self.active:
            self.offset[:] = 0.0
            self.velocity[:] = 0.0

    def write(self, out: Array) -> None:
        """Write the complete state, shape (`YIELDING_FIELDS`,)."""
        out[0:3], out[3:6] = self.offset, self.velocity

    def take_over(self, numbers: Array) -> None:
        """Continue from the numbers of `write`."""
        self.offset[:], self.velocity[:] = numbers[0:3], numbers[3:6]
        self.active = bool(numbers[0:6].any())
