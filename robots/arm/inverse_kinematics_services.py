"""Answers which joints put the tool where: the nearest configuration, and all of them."""

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
from robots.arm.motion_runner import MotionRunner
from robots.model import inverse_kinematics
from robots.model.inverse_kinematics import JointSolution, PoseMatch, SolutionSet
from robots.model.transform import RigidTransform
from robots.port import Array

T = TypeVar("T")


class InverseKinematicsServices:
    """Answers InverseKinematics and AllInverseKinematics, for the tool centre point that is in force."""

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

        found = await self._solved(request.pose, request.seed, solve)
        return InverseKinematicsResult(
            joints=tuple(found.joints.tolist()),
            dexterity=found.posture.dexterity,
            manipulability=found.posture.manipulability,
            singular=found.posture.singular,
            remark=found.posture.words,
        )

    async def _all(self, request: AllInverseKinematics) -> InverseKinematicsSolutions:
        def solve(
            solver: inverse_kinematics.InverseKinematicsSolver, target: RigidTransform, seed: Array
        ) -> SolutionSet:
            return solver.all_solutions(target, seed=seed, match=PoseMatch.of(request.match))

        found = await self._solved(request.pose, request.seed, solve)
        return InverseKinematicsSolutions(
            solutions=tuple(tuple(joints.tolist()) for joints in found.joints),
            complete=found.complete,
            how=found.how,
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
            # Kinematics of its own: a motion may be planned meanwhile.
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
                f"no joints can be worked out from these numbers: {error}",
                where=runner.name,
                hint="look for a value that is far too great",
            ) from error
