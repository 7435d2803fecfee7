"""Plans one arm's motions: inline under virtual time, else in a worker thread so that the event loop stays free."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from typing import TypeVar

from engine.clock import Clock
from engine.errors import RobotError
from robots.model.inverse_kinematics import InverseKinematics
from robots.model.kinematics import ArmKinematics
from robots.model.rigid import Rigid
from robots.motion import plan_joints, plan_line
from robots.port import Array, JointTrajectory

T = TypeVar("T")


class ArmPlanner:
    """Makes trajectories that start at a set point at rest; all of it raises RobotError with the reason.

    One plan is made at a time; the arm's actions are exclusive, so none waits for another.
    """

    def __init__(self, kinematics: ArmKinematics, *, clock: Clock) -> None:
        self._kinematics = kinematics
        self._clock = clock

    async def to_joints(self, start: Array, goal: Array, *, speed: float) -> JointTrajectory:
        """Plan a joint motion to a configuration."""
        return await self._run(partial(self._to_joints, start, goal, speed))

    async def to_pose(self, start: Array, goal: Rigid, *, speed: float) -> JointTrajectory:
        """Plan a joint motion to the nearest configuration that puts the tool at `goal` (world)."""
        return await self._run(partial(self._to_pose, start, goal, speed))

    async def along_line(self, start: Array, goal: Rigid, *, duration_s: float) -> JointTrajectory:
        """Plan a straight line of the tool to `goal` (world)."""
        return await self._run(partial(plan_line, self._kinematics, start, goal, duration_s=duration_s))

    def _to_joints(self, start: Array, goal: Array, speed: float) -> JointTrajectory:
        model = self._kinematics.model
        return plan_joints(start, goal, speed=speed, limits=model.limits, joint_names=model.arm_joints)

    def _to_pose(self, start: Array, goal: Rigid, speed: float) -> JointTrajectory:
        try:
            joints = InverseKinematics(self._kinematics).nearest(goal, seed=start)
        except RobotError as error:
            raise RobotError(str(error), hint="choose a pose that the arm reaches within its limits") from error
        return self._to_joints(start, joints, speed)

    async def _run(self, plan: Callable[[], T]) -> T:
        if self._clock.virtual:
            # A thread would let virtual time depend on how fast this machine plans.
            return plan()
        return await asyncio.to_thread(plan)
