"""One goal along a given path: its trajectory is admitted only on a free path, and its motion is monitored."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Any, TypeVar, cast

import numpy as np

from engine.bus import ActiveGoal
from engine.skills.collision_options import CollisionOptions
from robots.arm.execution.begun_motion import canceled_by_errors
from robots.arm.execution.given_path_motion import GivenPathMotion
from robots.arm.execution.lookahead_path import PathReservation
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.scene_queries.path_guard import AdmittedPath, PathGuard, Timing
from robots.planning.request import ToolContact
from robots.port import Array, ForceTask, JointTrajectory, Motion

T = TypeVar("T", JointTrajectory, ForceTask)


class GivenPath:
    """The path of one goal; created by `given_path`."""

    def __init__(
        self,
        runner: MotionRunner,
        guard: PathGuard | None,
        options: CollisionOptions,
        *,
        tool_contact: ToolContact,
        timing: Timing,
    ) -> None:
        self._runner = runner
        self._guard = guard
        self._options = options
        self._tool_contact: ToolContact = tool_contact
        self._timing: Timing = timing
        self._admitted: AdmittedPath | None = None

    async def planned(self, handle: ActiveGoal[Any], plan: Callable[[Array], Awaitable[T]]) -> T:
        """Plan from the set point and accept the goal, or reject it, also because the path is not free.

        What is returned may be slower than planned, where it passes through space that no camera sees.
        """

        async def checked(start: Array) -> T:
            planned = await plan(start)
            if self._guard is None:
                return planned
            self._admitted = await self._guard.admit(
                planned.trajectory if isinstance(planned, ForceTask) else planned,
                options=self._options,
                tool_contact=self._tool_contact,
                kinematics=self._runner.kinematics,
                timing="fixed" if isinstance(planned, ForceTask) else self._timing,
            )
            return planned if isinstance(planned, ForceTask) else cast("T", self._admitted.trajectory)

        return await self._runner.planned(handle, checked)

    def monitored(self, motion: Motion) -> Motion:
        """Return the motion of the port, monitored on the path that was planned, and reserved for this arm."""
        if self._guard is None or self._admitted is None:
            return motion
        return monitored_motion(motion, self._admitted, self._runner, guard=self._guard, options=self._options)


def monitored_motion(
    motion: Motion, path: AdmittedPath, runner: MotionRunner, *, guard: PathGuard, options: CollisionOptions
) -> Motion:
    """Return a motion of the port along a path, monitored and reserved for this arm."""
    with canceled_by_errors(motion):
        return GivenPathMotion(
            motion,
            path.trajectory,
            path.rules,
            guard=guard,
            options=options,
            reservation=PathReservation(runner, guard.workspace, made=True),
            clock=runner.clock,
            acceleration_rad_s2=np.array(runner.model.limits.acceleration_rad_s2),
        )


@asynccontextmanager
async def given_path(
    runner: MotionRunner,
    options: CollisionOptions,
    *,
    tool_contact: ToolContact = "at_end",
    timing: Timing = "free",
) -> AsyncGenerator[GivenPath]:
    """Return the path of one goal; the cameras run meanwhile. Without a planning scene nothing is checked.

    `tool_contact` is the contact that is meant by this kind of motion; with a fixed `timing` it is never slowed.
    """
    guard = runner.path_guard if options.avoid else None
    if guard is None:
        yield GivenPath(runner, None, options, tool_contact=tool_contact, timing=timing)
        return
    async with guard.observed():
        yield GivenPath(runner, guard, options, tool_contact=tool_contact, timing=timing)
