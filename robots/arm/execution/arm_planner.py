"""Plans one arm's motions: inline under virtual time, else in a worker thread so that the event loop stays free."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Awaitable, Callable
from functools import partial
from importlib import import_module
from typing import TypeVar

import numpy as np

from engine.clock import Clock
from engine.errors import RobotError
from robots.model.inverse_kinematics import InverseKinematicsSolver, PoseMatch
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion import plan_joints, plan_line
from robots.motion.joint_checks import check_device_range
from robots.port import Array, ForceTask, JointTrajectory

T = TypeVar("T")
Loaded = Callable[[], Awaitable[None]]


class ArmPlanner:
    """Plans trajectories that start at a set point at rest; every method raises RobotError with the reason.

    Computes one plan at a time; the arm's actions are exclusive, so none waits for another. Plans that need
    inverse kinematics start when `loaded` returns.
    """

    def __init__(self, kinematics: ArmKinematics, *, clock: Clock, loaded: Loaded) -> None:
        self._kinematics = kinematics
        self._inverse = InverseKinematicsSolver(kinematics)
        self._clock = clock
        self._loaded = loaded
        # Nobody waits for a plan whose goal was canceled, but its thread still uses the kinematics.
        self._lock = threading.Lock()

    def prepare(self) -> None:
        """Load the modules that the first pose, line or waypoint would otherwise wait for; see decision 0013.

        Compiling them in the middle of a motion could silence the engine for so long that arms are braked.
        """
        self._inverse.prepare()
        import_module("robots.planning.timing.waypoint_timing")

    async def to_joints(self, start: Array, goal: Array, *, speed: float) -> JointTrajectory:
        """Plan a joint motion to a configuration."""
        return self._checked(await self._run(partial(self._to_joints, start, goal, speed)))

    async def to_pose(
        self, start: Array, goal: RigidTransform, *, speed: float, match: PoseMatch = PoseMatch.POSE
    ) -> JointTrajectory:
        """Plan a joint motion to the nearest configuration that brings the tool to the part of `goal` in `match`."""
        await self._loaded()
        return self._checked(await self._run(partial(self._to_pose, start, goal, speed, match)))

    async def along_line(self, start: Array, goal: RigidTransform, *, duration_s: float) -> JointTrajectory:
        """Plan a straight line of the tool to `goal` (world)."""
        await self._loaded()
        line = partial(plan_line, self._kinematics, start, goal, duration_s=duration_s)
        return self._checked(await self._run(line))

    async def make(self, plan: Callable[[ArmKinematics], T]) -> T:
        """Run a custom plan on the planner's kinematics; for motions only, of which one is planned at a time."""
        await self._loaded()
        made = await self._run(partial(plan, self._kinematics))
        if isinstance(made, JointTrajectory):
            self._checked(made)
        elif isinstance(made, ForceTask):
            self._checked(made.trajectory)
        return made

    def _checked(self, trajectory: JointTrajectory) -> JointTrajectory:
        """Return the trajectory if the robot's own controller (possibly coupled axes) would accept it; else raise."""
        model = self._kinematics.model
        check_device_range(model.joint_map, model.arm_joints, trajectory)
        return trajectory

    def _to_joints(self, start: Array, goal: Array, speed: float) -> JointTrajectory:
        model = self._kinematics.model
        return plan_joints(start, goal, speed=speed, limits=model.limits, joint_names=model.arm_joints)

    def _to_pose(self, start: Array, goal: RigidTransform, speed: float, match: PoseMatch) -> JointTrajectory:
        try:
            joints = self._inverse.nearest(goal, seed=start, match=match)
        except RobotError as error:
            hint = error.hint or "choose a pose that the arm reaches within its limits"
            raise RobotError(error.message, hint=hint) from error
        return self._to_joints(start, joints, speed)

    async def _run(self, plan: Callable[[], T]) -> T:
        # The checks of each plan reject overflow with a message; numpy warnings are redundant.
        with np.errstate(all="ignore"):
            if self._clock.virtual:
                # A thread would make virtual time depend on the planning speed of this machine.
                return plan()
            return await asyncio.to_thread(self._plan_locked, plan)

    def _plan_locked(self, plan: Callable[[], T]) -> T:
        with self._lock:
            return plan()
