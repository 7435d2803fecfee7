"""Plans paths for one arm in the live scene of its cell, and checks the paths that it follows."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec

from engine.errors import RobotError
from engine.messages import Pose
from engine.skills.planning import PlanOptions
from robots.planning.request import (
    CollisionRequest,
    JointGoal,
    PathCheck,
    PathCheckRequest,
    PathGoal,
    PathOrientationConstraint,
    PathPlan,
    PlanRefusal,
    PlanRequest,
    PoseGoal,
    RefusalReason,
)
from robots.planning.scene.planning_scene import NamePair, PlanningScene
from robots.port import Array, JointTrajectory
from robots.workspace.path_reservations import describe_names
from robots.workspace.workspace import Workspace

EXTRA_MARGIN_M = 0.015
"""Planning keeps this much more clearance than monitoring requires; else the next image might block the path."""

_SPARE_SHARE = 0.5
TRANSIENT_REASONS: tuple[RefusalReason, ...] = (
    "goal_in_collision",
    "start_in_collision",
    "no_path_in_time",
    "way_blocked",
)
"""Refusals that may not recur without the extra margin, or once the obstacle is gone."""

PlanningGoal = JointGoal | PoseGoal | PathGoal


@dataclass(frozen=True, kw_only=True)
class PathSegment:
    """A validated, time-parameterized path that was planned with `margin_m`."""

    plan: PathPlan
    trajectory: JointTrajectory
    margin_m: float


class PathPlanner:
    """Queries the planners of a workspace for one goal of one arm.

    Args:
        arm: Name of the arm.
        workspace: Provides the scene, the occupancy and the planners.
        goal: The planning goal.
        options: The planning options.
        tool: The tool center point in the frame of the model's tool link; None for its origin.
    """

    def __init__(
        self, arm: str, workspace: Workspace, *, goal: PlanningGoal, options: PlanOptions, tool: Pose | None
    ) -> None:
        self.arm = arm
        self._workspace = workspace
        self._goal = goal
        self._options = options
        self._tool = tool

    async def find(self, start: Array, *, attempt: int = 0) -> PathSegment | PlanRefusal:
        """Plan a path from `start` (n,) in the current scene; each attempt uses another seed.

        Raises:
            RobotError: the planning process has ended.
            CellError: the scene is invalid.
        """
        options = self._options
        wide = await self._ask(start, options.margin_m + EXTRA_MARGIN_M, options.time_s * _SPARE_SHARE, attempt)
        if not isinstance(wide, PlanRefusal) or wide.reason not in TRANSIENT_REASONS:
            return wide
        return await self._ask(start, options.margin_m, options.time_s * (1.0 - _SPARE_SHARE), attempt)

    async def is_permanently_blocked(self, start: Array) -> bool:
        """Return whether there is no path even without transient obstacles: other arms and the occupancy.

        Raises as `find` does.
        """
        return isinstance(
            await self._ask(start, self._options.margin_m, self._options.time_s, 0, permanent=True), PlanRefusal
        )

    async def check(self, segment: PathSegment, *, from_s: float, margin_m: float) -> PathCheck:
        """Return where the remaining path is blocked in the current scene; raises as `find` does."""
        return await self._workspace.planners.check_path(self._check_request(segment.trajectory, from_s, margin_m))

    async def confirm(self, segment: PathSegment) -> PathCheck:
        """Return where a path that was just planned is blocked in the current scene; raises as `find` does."""
        return await self._workspace.planners.confirm_path(self._check_request(segment.trajectory, 0.0, self.margin_m))

    async def beside(self, joints: Array, *, within_m: float) -> tuple[NamePair, ...]:
        """Return the pairs within a distance of the arm at `joints` (n,); raises as `find` does."""
        workspace = self._workspace
        report = await workspace.planners.look(
            CollisionRequest(
                scene=workspace.scene_for(self.arm),
                arm=self.arm,
                joints_rad=tuple(float(q) for q in joints),
                occupancy=workspace.occupancy,
                margin_m=within_m,
            )
        )
        return tuple((pair.first, pair.second) for pair in report.touching)

    @property
    def margin_m(self) -> float:
        """The monitored margin."""
        return self._options.margin_m

    async def _ask(
        self, start: Array, margin_m: float, time_s: float, attempt: int, *, permanent: bool = False
    ) -> PathSegment | PlanRefusal:
        options, workspace = self._options, self._workspace
        scene = workspace.scene_for(self.arm)
        answer = await workspace.planners.plan(
            PlanRequest(
                scene=_without_others(scene, self.arm) if permanent else scene,
                arm=self.arm,
                start_rad=tuple(float(q) for q in start),
                goal=self._goal,
                planner=options.planner,
                time_s=time_s,
                seed=options.seed + attempt,
                margin_m=margin_m,
                keep_orientation=_orientation_constraint(options),
                tool=self._tool,
                speed=options.speed,
                occupancy=None if permanent else workspace.occupancy,
            )
        )
        if isinstance(answer, PlanRefusal):
            return msgspec.structs.replace(answer, message=describe_names(answer.message))
        if answer.timed is None:
            raise RobotError("the planner returned no trajectory", where=self.arm, hint="plan again")
        return PathSegment(plan=answer, trajectory=answer.timed, margin_m=margin_m)

    def _check_request(self, trajectory: JointTrajectory, from_s: float, margin_m: float) -> PathCheckRequest:
        workspace = self._workspace
        return PathCheckRequest(
            scene=workspace.scene_for(self.arm),
            arm=self.arm,
            trajectory=trajectory,
            from_s=from_s,
            occupancy=workspace.occupancy,
            margin_m=margin_m,
        )


def describe_contacts(pairs: tuple[NamePair, ...]) -> str:
    """Describe the contacts: `left/panda_hand would touch wall`."""
    if not pairs:
        return "the arm would touch something"
    first, second = pairs[0]
    more = f" and {len(pairs) - 1} more" if len(pairs) > 1 else ""
    return f"{describe_names(first)} would touch {describe_names(second)}{more}"


def _without_others(scene: PlanningScene, arm: str) -> PlanningScene:
    own = tuple(part for part in scene.attached if part.arm == arm)
    return msgspec.structs.replace(scene, arms=(scene.arm(arm),), attached=own)


def _orientation_constraint(options: PlanOptions) -> PathOrientationConstraint | None:
    wish = options.keep_orientation
    return (
        None
        if wish is None
        else PathOrientationConstraint(tolerance_rad=wish.tolerance_rad, free_about=wish.free_about)
    )
