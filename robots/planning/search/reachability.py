"""Reachability of targets by the arms of a cell document, with its fixtures alone; opens no simulation or device."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import msgspec
import numpy as np

from engine.document import Cell, MujocoWorld, cell_at_start
from engine.errors import RobotError
from engine.messages import Pose
from engine.skills.arm_target import ArmTarget, TargetViolation
from robots.model.inverse_kinematics import InverseKinematicsSolver, PoseMatch
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.planning.scene.cell_planning_scene import planning_scene
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import NamePair, PlanningScene
from robots.planning.search.endpoints import describe_touching
from robots.port import Array
from robots.scene.scene_builder import build_scene

_CONTACT_DEPTH_M = 0.005
"""Up to this depth contact with a fixture is allowed, such as of fingers around a part on a table."""
_BEYOND_RAD = 1e-6
_WORLD = "world"


class ReachabilityChecker:
    """Checks targets of the arms of a cell against its fixtures, except those on springs.

    Robots with real drivers are checked like simulated ones.

    Args:
        cell: The cell.
    """

    def __init__(self, cell: Cell) -> None:
        self._cell = cell
        self._arms: dict[str, _Arm] = {}

    def fault(self, target: ArmTarget) -> TargetViolation | None:
        """Return why an arm cannot reach a target; None if it can, or if another check covers the target.

        Raises:
            CellError: the scene of the cell cannot be built.
        """
        if target.robot not in self._cell.document.robots:
            return None
        arm = self._arms.get(target.robot)
        if arm is None:
            arm = self._arms[target.robot] = _Arm(self._scene, target.robot, frames=self._cell.document.fixed_frames)
        if target.pose is None:
            # Unknown joints, or joints outside the limits, are another finding.
            joints = np.array([target.joints])
            return arm.fault_at(joints) if arm.has(joints) else None
        match = PoseMatch[target.match.upper()]
        try:
            goal = arm.in_world(target.pose)
            if goal is None:
                return None
            # Computing all solutions takes a hundred times as long and is rarely needed.
            if arm.fault_at(arm.inverse.nearest(goal, seed=arm.home, match=match)[None]) is None:
                return None
            return arm.fault_at(arm.inverse.all_solutions(goal, match=match).joints)
        except RobotError as error:
            message = f"`{target.robot}` does not reach it: {error.message}"
            return TargetViolation(kind="unreachable", message=message, hint=error.hint or "")
        except ValueError as error:
            return TargetViolation(kind="unreachable", message=str(error), hint="give meters, and a quaternion x y z w")

    @cached_property
    def _scene(self) -> PlanningScene:
        # What is plugged later has no place yet, or one where another module is.
        document = cell_at_start(self._cell)
        drawn = msgspec.structs.replace(
            document,
            world=document.world or MujocoWorld(),
            robots={name: msgspec.structs.replace(robot, driver="sim") for name, robot in document.robots.items()},
            fixtures={name: one for name, one in document.fixtures.items() if one.spring is None},
            parts={},
            people={},
        )
        return planning_scene(build_scene(drawn, resolve=self._cell.resolve))


class _Arm:
    """One arm with the fixtures, without the other arms, whose joints are unknown."""

    def __init__(self, scene: PlanningScene, name: str, *, frames: Mapping[str, Pose]) -> None:
        self._name = name
        arm = scene.arm(name)
        self._checker = ExactChecker(msgspec.structs.replace(scene, arms=(arm,)), name)
        base = RigidTransform.from_pose(arm.placement.base)
        self._outer = {
            f"{name}/{self._checker.model.base_link}": base,
            **{frame: RigidTransform.from_pose(pose) for frame, pose in frames.items()},
        }
        self.home = np.array(self._checker.model.home_rad)
        self.inverse = InverseKinematicsSolver(ArmKinematics(self._checker.model, base=base))

    def in_world(self, pose: Pose) -> RigidTransform | None:
        """Return a pose in the world; None if its frame is neither the world nor the base, nor a frame of the cell."""
        if pose.frame == _WORLD:
            return RigidTransform.from_pose(pose)
        outer = self._outer.get(pose.frame)
        return outer.then(RigidTransform.from_pose(pose)) if outer is not None else None

    def has(self, rows: Array) -> bool:
        """Return whether configurations (k, n) fit this arm and its limits."""
        limits = self._checker.model.limits
        lower, upper = np.array(limits.lower_rad), np.array(limits.upper_rad)
        return rows.shape[1:] == lower.shape and bool(
            ((rows >= lower - _BEYOND_RAD) & (rows <= upper + _BEYOND_RAD)).all()
        )

    def fault_at(self, rows: Array) -> TargetViolation | None:
        """Return the violation if all configurations (k, n) collide; None if one of them is free."""
        touching: tuple[NamePair, ...] = ()
        for row in rows:
            colliding = self._collisions(row)
            if not colliding:
                return None
            touching = touching or colliding
        others = "" if len(rows) == 1 else f"; {len(rows) - 1} other configurations collide as well"
        hint = "choose another target, or move the fixture"
        return TargetViolation(
            kind="collision", message=f"at the target {describe_touching(touching)}{others}", hint=hint
        )

    def _collisions(self, joints: Array) -> tuple[NamePair, ...]:
        """Return the colliding pairs; shallow contact with a fixture is allowed."""
        checker = self._checker
        return tuple(
            pair
            for pair in checker.colliding_pairs(joints)
            if all(name.startswith(f"{self._name}/") for name in pair)
            or checker.depth(joints, frozenset(pair)) > _CONTACT_DEPTH_M
        )
