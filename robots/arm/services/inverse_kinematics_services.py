"""The inverse kinematics services: the nearest configuration for a tool pose, and all configurations."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from engine.bus import SkillBus
from engine.errors import RobotError, SkillFailed
from engine.messages import Pose
from engine.skills.motion import (
    AllInverseKinematics,
    InverseKinematics,
    InverseKinematicsResult,
    InverseKinematicsSolutions,
)
from robots.arm.execution.motion_runner import MotionRunner
from robots.model import inverse_kinematics
from robots.model.inverse_kinematics import JointSolution, PoseMatch, SolutionSet
from robots.model.transform import RigidTransform
from robots.port import Array

T = TypeVar("T")


class InverseKinematicsServices:
    """Serves InverseKinematics and AllInverseKinematics, for the current tool center point."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner

    def register(self, bus: SkillBus) -> None:
        """Advertise the services under the arm's name."""
        name = self._runner.name
        bus.advertise_service(InverseKinematics, self._nearest, namespace=name)
        bus.advertise_service(AllInverseKinematics, self._all, namespace=name)

    async def _nearest(self, request: InverseKinematics) -> InverseKinematicsResult:
        def solve(
            solver: inverse_kinematics.InverseKinematicsSolver, target: RigidTransform, seed: Array
        ) -> JointSolution:
            return solver.solve(target, seed=seed, match=PoseMatch.of(request.match))

        solution = await self._solved(request.pose, request.seed, solve)
        return InverseKinematicsResult(
            joints=tuple(solution.joints.tolist()),
            dexterity=solution.posture.dexterity,
            manipulability=solution.posture.manipulability,
            singular=solution.posture.singular,
            remark=solution.posture.words,
        )

    async def _all(self, request: AllInverseKinematics) -> InverseKinematicsSolutions:
        def solve(
            solver: inverse_kinematics.InverseKinematicsSolver, target: RigidTransform, seed: Array
        ) -> SolutionSet:
            return solver.all_solutions(target, seed=seed, match=PoseMatch.of(request.match))

        solution = await self._solved(request.pose, request.seed, solve)
        return InverseKinematicsSolutions(
            solutions=tuple(tuple(joints.tolist()) for joints in solution.joints),
            complete=solution.complete,
            how=solution.how,
        )

    async def _solved(
        self,
        pose: Pose,
        seed: tuple[float, ...],
        solve: Callable[[inverse_kinematics.InverseKinematicsSolver, RigidTransform, Array], T],
    ) -> T:
        runner = self._runner
        try:
            target = runner.frames.to_world(pose)
            start = np.array(seed) if seed else runner.port.sample().position_rad.copy()
            # Separate kinematics: a motion may be planned at the same time.
            await runner.loaded()
            solver = inverse_kinematics.InverseKinematicsSolver(runner.kinematics.twin())
            with np.errstate(all="ignore"):
                if runner.clock.virtual:
                    return solve(solver, target, start)
                return await asyncio.to_thread(solve, solver, target, start)
        except RobotError as error:
            raise SkillFailed(error.message, where=runner.name, hint=error.hint) from None
        except (ArithmeticError, ValueError) as error:
            raise SkillFailed(
                f"no joints can be computed from these numbers: {error}",
                where=runner.name,
                hint="check the request for values that are too large",
            ) from error
