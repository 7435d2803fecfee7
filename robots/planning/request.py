"""Requests to planners and their answers, as data that can cross a process boundary."""

from __future__ import annotations

from typing import Literal

import msgspec
import numpy as np

from engine.errors import RobotError
from engine.messages import Pose, Vector3
from engine.messages.sensing import OccupancyGrid
from robots.planning.planner_names import FAST
from robots.planning.scene.planning_scene import NamePair, PlanningScene
from robots.port import Array, JointTrajectory

RefusalReason = Literal[
    "start_in_collision",
    "start_outside_limits",
    "goal_in_collision",
    "goal_outside_limits",
    "goal_unreachable",
    "way_blocked",
    "no_path_in_time",
    "unknown_space",
    "unknown_planner",
    "cancelled",
]


class JointGoal(msgspec.Struct, frozen=True, kw_only=True, tag="joints"):
    """Any of these goal configurations, radians, n each."""

    joints_rad: tuple[tuple[float, ...], ...]


class PoseGoal(msgspec.Struct, frozen=True, kw_only=True, tag="pose"):
    """The tool center point at a pose in the world; `match` selects what of the pose counts, see `PoseMatch`."""

    pose: Pose
    match: Literal["pose", "position", "axis"] = "pose"


class PathGoal(msgspec.Struct, frozen=True, kw_only=True, tag="path"):
    """A given path of straight joint lines, radians, n each: it is validated and timed, without a search.

    Its first waypoint is the start configuration.
    """

    waypoints_rad: tuple[tuple[float, ...], ...]


class PathOrientationConstraint(msgspec.Struct, frozen=True, kw_only=True):
    """The tool link keeps its orientation at the start, within a tolerance.

    With `free_about`, an axis in the frame of the tool link, it may rotate about that axis: (0, 0, 1) for a full
    cup.
    """

    tolerance_rad: float = 0.1
    free_about: Vector3 | None = None


class PlanRequest(msgspec.Struct, frozen=True, kw_only=True, tag="ask_plan"):
    """Requests a path for one arm of a scene from `start_rad` to any of its goals.

    `planner` is `fast`, `stomp` or the name of an OMPL planner. `time_s` covers the whole request; the same request
    with the same `seed` has the same answer unless time runs out. The path keeps at least `margin_m` from
    obstacles, other arms and `occupancy`, the map of the cameras, whose name in pairs is `occupancy`. An arm that
    starts within the margin leaves it first without coming nearer. `tool` is the tool center point in the frame
    of the model's tool link. With a `speed`, the share of the joint speed limits, the answer includes a trajectory.
    """

    scene: PlanningScene
    arm: str
    start_rad: tuple[float, ...]
    goal: JointGoal | PoseGoal | PathGoal
    planner: str = FAST
    time_s: float = 1.0
    seed: int = 0
    margin_m: float = 0.0
    keep_orientation: PathOrientationConstraint | None = None
    tool: Pose | None = None
    speed: float | None = None
    occupancy: OccupancyGrid | None = None


class PlanStats(msgspec.Struct, frozen=True, kw_only=True):
    """Effort of an answer.

    Seconds of search, shortening, exact verification and timing; configurations checked by the search and by the
    verification; number of paths rejected by the exact check; the planner that found the path.
    """

    search_s: float
    shortening_s: float
    verification_s: float
    timing_s: float
    checks: int
    exact_checks: int
    refused_paths: int
    found_by: str


class PathPlan(msgspec.Struct, frozen=True, kw_only=True, tag="plan"):
    """A path of straight joint lines that the exact checker has validated: waypoints of n joints each.

    `timed` is the trajectory, with blended corners that are validated as well, if a speed was given.
    """

    waypoints_rad: tuple[tuple[float, ...], ...]
    stats: PlanStats
    timed: JointTrajectory | None = None

    @property
    def path(self) -> Array:
        """The waypoints, shape (k, n)."""
        return np.array(self.waypoints_rad, dtype=np.float64)


class PlanRefusal(msgspec.Struct, frozen=True, kw_only=True, tag="refusal"):
    """Why there is no plan; `pairs` are the names of the colliding objects, if that is the reason."""

    reason: RefusalReason
    message: str
    hint: str = ""
    pairs: tuple[NamePair, ...] = ()

    def error(self) -> RobotError:
        """Return the error for callers that need a plan."""
        return RobotError(self.message, hint=self.hint or None)


PlanAnswer = PathPlan | PlanRefusal


ToolContact = Literal["never", "at_end", "ends_path", "along_path"]
"""Where the tool, and what it holds, may touch fixtures and parts; see `motion_check`."""


class PathCheckRequest(msgspec.Struct, frozen=True, kw_only=True, tag="ask_path_check"):
    """Asks whether an arm that follows `trajectory` collides from `from_s` of the trajectory's own time on.

    A trajectory that was not planned has its `tool_contact`, and what touches at its start may stay in contact; a
    planned one has neither.
    """

    scene: PlanningScene
    arm: str
    trajectory: JointTrajectory
    from_s: float
    occupancy: OccupancyGrid | None = None
    margin_m: float = 0.0
    tool_contact: ToolContact | None = None


class AttachedPartCheckRequest(msgspec.Struct, frozen=True, kw_only=True, tag="ask_attached_part_check"):
    """Asks whether an attached part collides along `trajectory`; see `attached_part_check` for the allowed contacts.

    The scene does not allow contact with the objects that held parts rest on.
    """

    scene: PlanningScene
    arm: str
    trajectory: JointTrajectory


class PathCheck(msgspec.Struct, frozen=True, kw_only=True, tag="way_check"):
    """The time of the first collision on a trajectory, in its own time, and the pairs; None if it is free.

    `looked_s` is the time up to which the trajectory was checked: that of the collision, or its end.
    """

    blocked_at_s: float | None
    pairs: tuple[NamePair, ...]
    looked_s: float


class CollisionRequest(msgspec.Struct, frozen=True, kw_only=True, tag="ask_collisions"):
    """Asks for the collisions of an arm at `joints_rad`, and its clearance.

    Obstacles, other arms and `occupancy` nearer than `margin_m` count as touching.
    """

    scene: PlanningScene
    arm: str
    joints_rad: tuple[float, ...]
    occupancy: OccupancyGrid | None = None
    margin_m: float = 0.0


class PairDistanceRequest(msgspec.Struct, frozen=True, kw_only=True, tag="ask_pair_distances"):
    """Asks how far two bodies, by name, are from each other with an arm at several configurations (radians, n each).

    Bodies nearer than `margin_m` count as touching.
    """

    scene: PlanningScene
    arm: str
    rows_rad: tuple[tuple[float, ...], ...]
    pair: NamePair
    occupancy: OccupancyGrid | None = None
    margin_m: float = 0.0


class PairDistances(msgspec.Struct, frozen=True, kw_only=True, tag="pair_distances"):
    """Distances of a pair in metres, negative inside, one for each configuration.

    `touches_another` is true where a pair touches that does not touch at the first configuration.
    """

    distance_m: tuple[float, ...]
    touches_another: tuple[bool, ...]
