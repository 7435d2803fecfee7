"""The directions of a jog that take two bodies apart which the arm stands between."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from engine.skills.jogging import JogBlock, JogDirection
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.scene_queries.scene_check import SceneCheck
from robots.planning.scene.planning_scene import NamePair
from robots.port import Array

# Smallest gain of the distance after a step that counts as apart: beyond the rounding of the checks.
APART_M = 2e-4


class DirectionsOut:
    """Tries a small step in every direction of a jog.

    Args:
        runner: The arm's motion runner.
        steps: Returns, for joints (n,), the small joint steps (k, n) along the positive directions of the jog.
    """

    def __init__(self, runner: MotionRunner, steps: Callable[[Array], Array]) -> None:
        self._runner = runner
        self._steps = steps

    async def find(self, scene: SceneCheck, pair: NamePair) -> JogBlock:
        """Return the distance of a pair, and the directions that increase it and lead into nothing else.

        Raises:
            RobotError: the planning process has ended.
            CellError: the scene is invalid.
        """
        joints = self._runner.port.sample().desired_rad.copy()
        steps = self._steps(joints)
        rows = np.concatenate((joints[None], joints + steps, joints - steps))
        found = await scene.distances(rows, pair)
        start_m = found.distance_m[0]
        signs = [(axis, sign) for sign in (1, -1) for axis in range(len(steps))]
        return JogBlock(
            robot=self._runner.name,
            first=pair[0],
            second=pair[1],
            distance_m=max(0.0, start_m),
            directions_out=tuple(
                sorted(
                    (
                        JogDirection(axis=axis, sign=sign)
                        for (axis, sign), distance_m, touches in zip(
                            signs, found.distance_m[1:], found.touches_another[1:], strict=True
                        )
                        if distance_m > start_m + APART_M and not touches
                    ),
                    key=lambda each: (each.axis, -each.sign),
                )
            ),
        )
