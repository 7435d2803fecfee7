"""Plans paths for one arm in the live scene of its cell, and checks the paths that it follows."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import msgspec

from engine.errors import PathBlocked, RobotError
from engine.messages import Pose
from engine.messages.sensing import OccupancyGrid
from engine.skills.planning import PlanOptions
from robots.arm.scene_queries.unknown_space_check import UnknownSpaceCheck
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
from robots.scene.sim_scene import LOOSE_HINT
from robots.vision.occupancy.inflated_occupancy import inflated
from robots.workspace.path_reservations import describe_names
from robots.workspace.unknown_space import SLOW_SPEED
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

_log = logging.getLogger("flexcell.arm")

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
        self._unknown_space = UnknownSpaceCheck(arm, workspace)

    async def find(self, start: Array, *, attempt: int = 0, apart_m: float = 0.0) -> PathSegment | PlanRefusal:
        """Plan a path from `start` (n,) in the current scene; each attempt uses another seed.

        With `apart_m` its links keep that distance from all that the cameras see. What becomes of a path through
        space that no camera has seen is what the cell demands.

        Raises:
            RobotError: the planning process has ended.
            CellError: the scene is invalid.
        """
        found = await self._search(start, attempt, apart_m)
        if isinstance(found, PlanRefusal):
            return found
        return await self._through_known_space(found, start, attempt)

    async def _search(self, start: Array, attempt: int, apart_m: float) -> PathSegment | PlanRefusal:
        options, grid = self._options, self._workspace.occupancy
        if apart_m > options.margin_m and grid is not None:
            wider = inflated(grid, apart_m - options.margin_m)
            return await self._ask(start, options.margin_m, options.time_s, attempt, occupancy=wider)
        wide = await self._ask(start, options.margin_m + EXTRA_MARGIN_M, options.time_s * _SPARE_SHARE, attempt)
        if not isinstance(wide, PlanRefusal) or wide.reason not in TRANSIENT_REASONS:
            return wide
        return await self._ask(start, options.margin_m, options.time_s * (1.0 - _SPARE_SHARE), attempt)

    async def _through_known_space(self, segment: PathSegment, start: Array, attempt: int) -> PathSegment | PlanRefusal:
        """Return the path, another one, a slower one, or the refusal of the unknown space on it."""
        check, workspace, options = self._unknown_space, self._workspace, self._options
        policy = workspace.unknown_space.policy
        looks = check.once_observed if policy == "look_first" else check.on
        swept = await looks(segment.trajectory)
        if swept is None:
            return segment
        if policy == "slow":
            speed = min(options.speed, SLOW_SPEED)
            _log.info(
                "%s moves at %.0f %% of its speed: %s",
                self.arm,
                100.0 * speed,
                check.refusal(swept, segment.trajectory).message,
            )
            return await self._ask(start, segment.margin_m, options.time_s, attempt, speed=speed)
        grid, observed = workspace.occupancy, workspace.observed
        if grid is not None and observed is not None:
            known_only = workspace.unknown_space.as_occupied(grid, observed)
            around = await self._ask(start, segment.margin_m, options.time_s, attempt, occupancy=known_only)
            if isinstance(around, PathSegment) and await check.on(around.trajectory) is None:
                return around
        return check.refusal(swept, segment.trajectory)

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

    async def beside(self, joints: Array, *, within_m: float, occupancy: OccupancyGrid | None) -> tuple[NamePair, ...]:
        """Return the pairs within a distance of the arm at `joints` (n,), by a map; raises as `find` does."""
        workspace = self._workspace
        report = await workspace.planners.look(
            CollisionRequest(
                scene=workspace.scene_for(self.arm),
                arm=self.arm,
                joints_rad=tuple(float(q) for q in joints),
                occupancy=occupancy,
                margin_m=within_m,
            )
        )
        return tuple((pair.first, pair.second) for pair in report.touching)

    @property
    def margin_m(self) -> float:
        """The monitored margin."""
        return self._options.margin_m

    async def _ask(
        self,
        start: Array,
        margin_m: float,
        time_s: float,
        attempt: int,
        *,
        permanent: bool = False,
        speed: float | None = None,
        occupancy: OccupancyGrid | None = None,
    ) -> PathSegment | PlanRefusal:
        options, workspace = self._options, self._workspace
        scene = with_fixed_base(workspace.scene_for(self.arm), self.arm)
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
                speed=options.speed if speed is None else speed,
                occupancy=None if permanent else occupancy or workspace.occupancy,
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
            scene=with_fixed_base(workspace.scene_for(self.arm), self.arm),
            arm=self.arm,
            trajectory=trajectory,
            from_s=from_s,
            occupancy=workspace.occupancy,
            margin_m=margin_m,
        )


def with_fixed_base(scene: PlanningScene, arm: str) -> PlanningScene:
    """Return the scene, for an arm whose path leads to a known place; raises PathBlocked while its base is loose."""
    if scene.arm(arm).placement.loose:
        raise PathBlocked(
            f"the base of {arm} is released: nobody knows where its path leads", where=arm, hint=LOOSE_HINT
        )
    return scene


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
