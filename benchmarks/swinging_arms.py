"""Both arms of the demo cell swinging to and fro, commanded directly."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from robots.control.commanding.arm_commands import FollowTrajectory
from robots.control.motion_event import MotionFinished
from robots.model.registry import model_by_name
from robots.port import Array, JointTrajectory, MotionEnd, Tolerance
from robots.sim.loop.simulation import Simulation
from robots.sim.world.sim_world import SimWorld

CELL = Path(__file__).parents[1] / "behaviors" / "cells" / "dual_panda.yaml"
_SWING_S = 1.5
_BY_RAD = (0.4, 0.2, -0.3, 0.3, 0.3, -0.3, 0.5)


def swings() -> tuple[JointTrajectory, JointTrajectory]:
    """Return the path to and fro, from where a Panda is at home."""
    home = np.array(model_by_name("panda").home_rad)
    there = home + np.array(_BY_RAD)
    return _swing(home, there), _swing(there, home)


def _swing(start: Array, goal: Array) -> JointTrajectory:
    """Return a minimum-jerk motion between two configurations."""
    u = np.linspace(0.0, 1.0, round(_SWING_S / 0.001) + 1)[:, None]
    return JointTrajectory(
        dt_s=0.001,
        position_rad=start + (goal - start) * (10 * u**3 - 15 * u**4 + 6 * u**5),
        velocity_rad_s=(goal - start) * (30 * u**2 - 60 * u**3 + 30 * u**4) / _SWING_S,
    )


class Swinging:
    """Keeps every arm of a simulation moving."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._trajectories = swings()
        self._arms: dict[int, tuple[str, int]] = {}
        self._number = 0
        for arm in simulation.summary.arms:
            self._start(arm.name, 0)

    def _start(self, arm: str, direction: int) -> None:
        self._number += 1
        self._arms[self._number] = (arm, direction)
        self._simulation.apply(
            FollowTrajectory(
                arm=arm, motion=self._number, trajectory=self._trajectories[direction], tolerance=Tolerance()
            )
        )

    def step(self) -> None:
        """Let one step pass and start the next swing where one has ended."""
        for event in self._simulation.step():
            if isinstance(event, MotionFinished):
                if event.report.end != MotionEnd.REACHED:
                    raise RuntimeError(f"an arm did not get there: {event.report.reason}")
                arm, direction = self._arms.pop(event.motion)
                self._start(arm, 1 - direction)


async def swing_for_ever(world: SimWorld, arm: str) -> None:
    """Keep one arm of an open world moving until cancelled."""
    while True:
        for trajectory in swings():
            await world.arm(arm).follow(trajectory, tolerance=Tolerance()).report()
