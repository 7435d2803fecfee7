"""Arms put to targets in a cell as its document draws it, with its fixtures alone; nothing is opened."""

from __future__ import annotations

from functools import cached_property

import msgspec
import numpy as np

from engine.document.cell import Cell, MujocoWorld
from engine.errors import RobotError
from engine.messages import Pose
from engine.skills.arm_target import ArmTarget, TargetViolation
from robots.model.inverse_kinematics import InverseKinematicsSolver, PoseMatch
from robots.model.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.planning.scene.cell_planning_scene import planning_scene
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import NamePair, PlanningScene
from robots.planning.search.endpoints import describe_touching
from robots.port import Array
from robots.sim.scene.scene_builder import build_scene

_IN_M = 0.005
"""What is no deeper in a fixture than this touches it, as fingers do that reach round a part on a table."""
_BEYOND_RAD = 1e-6
_WORLD = "world"


class ReachabilityChecker:
    """The arms of a cell and its fixtures, without those that give way.

    Robots with drivers stand there as simulated ones would.

    Args:
        cell: The cell.
    """

    def __init__(self, cell: Cell) -> None:
        self._cell = cell
        self._arms: dict[str, _Arm] = {}

    def fault(self, target: ArmTarget) -> TargetViolation | None:
        """Return why an arm cannot be at a target.

        Raises:
            CellError: the cell cannot be built.
        """
        if target.robot not in self._cell.document.robots:
            return None
        arm = self._arms.get(target.robot)
        if arm is None:
            arm = self._arms[target.robot] = _Arm(self._scene, target.robot)
        if target.pose is None:
            # Joints that the arm has not, or not so far, are another finding.
            joints = np.array([target.joints])
            return arm.fault_at(joints) if arm.has(joints) else None
        match = PoseMatch[target.match.upper()]
        try:
            place = arm.in_world(target.pose)
            if place is None:
                return None
            # The list of all takes a hundred times as long, and mostly nobody needs it.
            if arm.fault_at(arm.inverse.nearest(place, seed=arm.home, match=match)[None]) is None:
                return None
            return arm.fault_at(arm.inverse.all_solutions(place, match=match).joints)
        except RobotError as error:
            message = f"`{target.robot}` does not get there: {error.message}"
            return TargetViolation(kind="unreachable", message=message, hint=error.hint or "")
        except ValueError as error:
            return TargetViolation(kind="unreachable", message=str(error), hint="give metres, and a quaternion x y z w")

    @cached_property
    def _scene(self) -> PlanningScene:
        document = self._cell.document
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
    """One arm among the fixtures, without the other arms, which may be anywhere."""

    def __init__(self, scene: PlanningScene, name: str) -> None:
        self._name = name
        arm = scene.arm(name)
        self._checker = ExactChecker(msgspec.structs.replace(scene, arms=(arm,)), name)
        base = RigidTransform.from_pose(arm.placement.base)
        self._base, self._base_frame = base, f"{name}/{self._checker.model.base_link}"
        self.home = np.array(self._checker.model.home_rad)
        self.inverse = InverseKinematicsSolver(ArmKinematics(self._checker.model, base=base))

    def in_world(self, pose: Pose) -> RigidTransform | None:
        """Return a pose in the world; None where its frame is neither that nor the base."""
        if pose.frame == _WORLD:
            return RigidTransform.from_pose(pose)
        return self._base.then(RigidTransform.from_pose(pose)) if pose.frame == self._base_frame else None

    def has(self, rows: Array) -> bool:
        """Tell whether configurations (k, n) are some of this arm, within its limits."""
        limits = self._checker.model.limits
        lower, upper = np.array(limits.lower_rad), np.array(limits.upper_rad)
        return rows.shape[1:] == lower.shape and bool(
            ((rows >= lower - _BEYOND_RAD) & (rows <= upper + _BEYOND_RAD)).all()
        )

    def fault_at(self, rows: Array) -> TargetViolation | None:
        """Return what is wrong with all configurations (k, n); None where one of them is right."""
        touching: tuple[NamePair, ...] = ()
        for row in rows:
            found = self._inside(row)
            if not found:
                return None
            touching = touching or found
        others = "" if len(rows) == 1 else f", and it is no better in {len(rows) - 1} other ways to stand there"
        hint = "choose another target, or move the fixture"
        return TargetViolation(kind="collision", message=f"there {describe_touching(touching)}{others}", hint=hint)

    def _inside(self, joints: Array) -> tuple[NamePair, ...]:
        """Return what is in one another; contact with a fixture is none."""
        checker = self._checker
        return tuple(
            pair
            for pair in checker.colliding_pairs(joints)
            if all(name.startswith(f"{self._name}/") for name in pair) or checker.depth(joints, frozenset(pair)) > _IN_M
        )
