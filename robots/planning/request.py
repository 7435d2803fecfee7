"""What planners are asked and what they answer, as data that can cross a process border."""

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
    "unknown_planner",
    "cancelled",
]


class JointGoal(msgspec.Struct, frozen=True, kw_only=True, tag="joints"):
    """Any of these configurations, radians, n each."""

    joints_rad: tuple[tuple[float, ...], ...]


class PoseGoal(msgspec.Struct, frozen=True, kw_only=True, tag="pose"):
    """The tool centre point at a pose in the world; `match` says what of the pose counts, as `PoseMatch` does."""

    pose: Pose
    match: Literal["pose", "position", "axis"] = "pose"


class PathGoal(msgspec.Struct, frozen=True, kw_only=True, tag="way"):
    """The end of this very way of straight joint lines, radians, n each: it is confirmed and timed, none is looked for.

    Its first waypoint is where the arm starts.
    """

    waypoints_rad: tuple[tuple[float, ...], ...]


class PathOrientationConstraint(msgspec.Struct, frozen=True, kw_only=True):
    """The tool link keeps the orientation that it has at the start, within a tolerance.

    With `free_about`, a direction in the frame of the tool link, it may turn about that: a full cup has
    (0, 0, 1).
    """

    tolerance_rad: float = 0.1
    free_about: Vector3 | None = None


class PlanRequest(msgspec.Struct, frozen=True, kw_only=True):
    """A way for one arm of a scene from `start_rad` to any of its goals.

    `planner` is `fast`, `stomp` or a planner of OMPL by name. `time_s` is for all of it; the same request
    with the same `seed` has the same answer unless time runs out. Obstacles and other arms are passed at
    `margin_m` at least, and so is `occupancy`, what cameras see; its name in pairs is `occupancy`. An arm that
    starts nearer than that leaves first, going no nearer. `tool` is the tool centre point in the frame of the
    model's tool link. With a `speed`, the share of the joint speed limits, the answer has a trajectory too.
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


class SampledTrajectory(msgspec.Struct, frozen=True, kw_only=True):
    """A trajectory at rest at both ends, sampled every `dt_s`: rows of n float64 numbers, row after row."""

    dt_s: float
    joints: int
    position_rad: bytes
    velocity_rad_s: bytes

    @classmethod
    def of(cls, trajectory: JointTrajectory) -> SampledTrajectory:
        """Return the data of a trajectory."""
        return cls(
            dt_s=trajectory.dt_s,
            joints=trajectory.position_rad.shape[1],
            position_rad=trajectory.position_rad.tobytes(),
            velocity_rad_s=trajectory.velocity_rad_s.tobytes(),
        )

    def trajectory(self) -> JointTrajectory:
        """Return what an arm can follow."""
        position, velocity = (
            np.frombuffer(data, dtype=np.float64).reshape(-1, self.joints)
            for data in (self.position_rad, self.velocity_rad_s)
        )
        return JointTrajectory(dt_s=self.dt_s, position_rad=position, velocity_rad_s=velocity)


class PlanStats(msgspec.Struct, frozen=True, kw_only=True):
    """What an answer took: seconds for search, shortening, exact verification and timing; configurations looked at by
    the search and by the verification; how many ways that were found the exact check refused; who found it."""

    search_s: float
    shortening_s: float
    verification_s: float
    timing_s: float
    checks: int
    exact_checks: int
    refused_ways: int
    found_by: str


class PathPlan(msgspec.Struct, frozen=True, kw_only=True, tag="plan"):
    """A way of straight joint lines that the exact checker has confirmed: waypoints of n joints each.

    `timed` is the trajectory, with rounded corners that are confirmed as well, where a speed was given.
    """

    waypoints_rad: tuple[tuple[float, ...], ...]
    stats: PlanStats
    timed: SampledTrajectory | None = None

    @property
    def path(self) -> Array:
        """The waypoints, shape (k, n)."""
        return np.array(self.waypoints_rad, dtype=np.float64)

    @property
    def length_rad(self) -> float:
        """The length of the way in joint space."""
        return float(np.linalg.norm(np.diff(self.path, axis=0), axis=1).sum())


class PlanRefusal(msgspec.Struct, frozen=True, kw_only=True, tag="refusal"):
    """Why there is no plan; `pairs` are the names of what touches, if that is the reason."""

    reason: RefusalReason
    message: str
    hint: str = ""
    pairs: tuple[NamePair, ...] = ()

    def error(self) -> RobotError:
        """Return the error for those who cannot go on without a plan."""
        return RobotError(self.message, hint=self.hint or None)


PlanAnswer = PathPlan | PlanRefusal


class PathCheckRequest(msgspec.Struct, frozen=True, kw_only=True):
    """Whether an arm that follows `way` would touch anything from `from_s` of the way's own time on."""

    scene: PlanningScene
    arm: str
    way: SampledTrajectory
    from_s: float
    occupancy: OccupancyGrid | None = None
    margin_m: float = 0.0


class AttachedPartCheckRequest(msgspec.Struct, frozen=True, kw_only=True):
    """Whether what an arm holds would touch anything along `way`; see `attached_part_check` for what it may touch.

    The scene does not allow what the held parts touch by lying on it.
    """

    scene: PlanningScene
    arm: str
    way: SampledTrajectory


class PathCheck(msgspec.Struct, frozen=True, kw_only=True, tag="way_check"):
    """The first instant of a way's own time at which the arm would touch something, and what; None where it is free.

    `looked_s` is the instant up to which the way was looked at: that of the touch, or the way's end.
    """

    blocked_at_s: float | None
    pairs: tuple[NamePair, ...]
    looked_s: float


class CollisionRequest(msgspec.Struct, frozen=True, kw_only=True):
    """What an arm touches at `joints_rad`, and how near it is to what it must not touch.

    Obstacles, other arms and `occupancy` nearer than `margin_m` count as touching.
    """

    scene: PlanningScene
    arm: str
    joints_rad: tuple[float, ...]
    occupancy: OccupancyGrid | None = None
    margin_m: float = 0.0
