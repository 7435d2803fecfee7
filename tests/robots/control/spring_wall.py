"""A massless spring wall in front of the plane arm, and the arm as it feels it: steps a generator in virtual time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.generators.motion_generator import MotionGenerator
from robots.port import Array
from tests.robots.control.plane_arm import plane_state

STEP_S = 0.001


@dataclass
class Wall:
    """It pushes the tool back along -y of the world, `stiffness_n_m` times how deep the tool is in it.

    `surface_m` gives y of the surface for x of the tool.
    """

    stiffness_n_m: float
    surface_m: Callable[[float], float]

    def wrench(self, tip: Array) -> Array:
        """Return what it does to the tool at `tip`, (6,), world."""
        depth = max(0.0, float(tip[1]) - self.surface_m(float(tip[0])))
        return np.array([0.0, -self.stiffness_n_m * depth, 0.0, 0.0, 0.0, 0.0])


@dataclass
class WallRig:
    """An arm that follows its set point perfectly, `delay` periods later, against a wall."""

    generator: MotionGenerator
    wall: Wall
    delay: int = 0
    noise_n: float = 0.0
    state: ArmState = field(default_factory=plane_state)
    forces: list[float] = field(default_factory=list[float])
    tips: list[Array] = field(default_factory=list[Array])

    def __post_init__(self) -> None:
        self._past = [self.generator.position.copy()] * (self.delay + 1)
        self._random = np.random.default_rng(0)

    def step(self, *, pace: float = 1.0) -> None:
        """Let one period pass."""
        self.state.refill(self._past[0], self.generator.velocity)
        tip = self.state.tool.xyz
        self.state.wrench[:] = self.wall.wrench(tip)
        self.state.wrench[1] += self.noise_n * self._random.standard_normal()
        self.generator.step(STEP_S, target_pace=pace, state=self.state)
        self._past = [*self._past[1:], self.generator.position.copy()]
        self.forces.append(float(self.state.wrench[1]))
        self.tips.append(tip)

    def run(self, *, pace: float = 1.0, limit: int = 20000) -> None:
        """Step until the generator is complete, or cannot go on and stands still."""
        for _ in range(limit):
            self.step(pace=pace if not self.generator.failure else 0.0)
            if self.generator.complete or (self.generator.failure and self.generator.stopped):
                return
        raise AssertionError(f"not complete after {limit} periods")
