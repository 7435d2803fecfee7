"""Collision-free motion of one arm, served under the arm's name: plan a path, execute a plan, plan and execute.

Plans use the planning scene of the cell (see `planning_scene`) and its occupancy from the cameras. An adaptive
motion monitors all changes during the motion: on a predicted collision the arm decelerates, plans another path
from its present configuration and continues; while there is no path, it waits.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import msgspec
from msgspec import UNSET, UnsetType

from engine.messages import Message, Pose, Vector3
from engine.skill import Action, Capability
from engine.skills.collision_options import BlockedPathTimeout
from engine.skills.motion import PoseMatch, Speed

PlannerName = Annotated[
    str,
    msgspec.Meta(
        description="`fast`, `stomp`, or a planner of OMPL such as `RRTConnect`, `RRT`, `PRM`, `KPIECE1`",
        extra_json_schema={"cell_name": "planner"},
    ),
]
PlanningTime = Annotated[
    float, msgspec.Meta(gt=0.0, le=60.0, description="Maximum planning time", extra_json_schema={"unit": "s"})
]
Margin = Annotated[
    float,
    msgspec.Meta(ge=0.0, le=0.2, description="Clearance from obstacles", extra_json_schema={"unit": "m"}),
]
Tilt = Annotated[
    float, msgspec.Meta(gt=0.0, le=3.2, description="Maximum rotation of the tool", extra_json_schema={"unit": "rad"})
]

MotionPhase = Literal["planning", "moving", "braking", "waiting"]


class KeepOrientation(Message, frozen=True, kw_only=True):
    """The tool keeps its orientation at the start, within a tolerance.

    The tool may rotate about `free_about`, a direction in the frame of the tool: (0, 0, 1) for a full cup.
    """

    tolerance_rad: Tilt = 0.1
    free_about: Vector3 | None = None


class MotionTarget(Message, frozen=True, kw_only=True):
    """The target: either `joints` (radians) or the part of `pose` of the tool centre point that `match` selects."""

    joints: tuple[float, ...] = ()
    pose: Pose | None = None
    match: PoseMatch = "pose"


class PlanOptions(Message, frozen=True, kw_only=True):
    """Options of a planning request: planner, time limit, seed, clearance, speed."""

    planner: PlannerName = "fast"
    time_s: PlanningTime = 1.0
    seed: int = 0
    margin_m: Margin = 0.0
    keep_orientation: KeepOrientation | None = None
    speed: Speed = 0.3


class PlannedMotion(Message, frozen=True, kw_only=True):
    """A collision-free path: waypoints connected by straight lines in joint space, from the start.

    The execution blends its corners and times it for `speed`, which takes `duration_s`. `tool_path` are points of
    the tool centre along the path, in the world, for drawing. `found_by` is the planner that found the path,
    `planning_s` the time for planning, shortening, validation and time parameterization.
    """

    robot: str
    waypoints: tuple[tuple[float, ...], ...]
    speed: Speed
    duration_s: float
    tool_path: tuple[Vector3, ...]
    found_by: str
    planning_s: float


class PlanFeedback(Message, frozen=True, kw_only=True):
    """The elapsed planning time."""

    elapsed_s: float


class PlanMotion(Action[PlannedMotion, PlanFeedback], frozen=True, kw_only=True):
    """Plan a collision-free path to `target` and publish it; the arm is not commanded and may be moving.

    Starts at `start` (radians), or at the arm's present set point when empty. Fails with the reason: a collision
    at the start or at the goal, an unreachable goal, or no path found.
    """

    target: MotionTarget
    start: tuple[float, ...] = ()
    options: PlanOptions = PlanOptions()


class FreeMotionFeedback(Message, frozen=True, kw_only=True):
    """The state of a collision-free motion: `progress` along the present path, 0 to 1, and why it brakes or waits.

    `replans` counts the new paths found during the motion, `waited_s` is the time without a path.
    """

    phase: MotionPhase
    joints: tuple[float, ...]
    progress: float
    replans: int
    waited_s: float
    reason: str = ""


class FreeMotionResult(Message, frozen=True, kw_only=True):
    """The measured configuration at the end, radians, and statistics of the motion.

    `stops` counts the stops before a predicted collision, `replans` the continuations along another path,
    `reused` those along the old path because it was free again. `blocked` names the obstacle when the motion was
    given up because its path was blocked for longer than its patience; else it is empty. `deviation_rad` is how far
    the joint that is farthest from its set point is at the end; it is unset in older recordings.
    """

    joints: tuple[float, ...]
    duration_s: float
    stops: int
    replans: int
    reused: int
    waited_s: float
    blocked: str = ""
    deviation_rad: float | UnsetType = UNSET


class Adaptation(Message, frozen=True, kw_only=True):
    """Reaction to changes during the motion: whether to monitor the path, and how long to wait for a free path.

    Without `watch` the arm does not react to new obstacles. With `patience_s` 0 it does not wait: it fails
    with the reason, at rest.
    """

    watch: bool = True
    patience_s: BlockedPathTimeout = 60.0


class ExecutePlan(Action[FreeMotionResult, FreeMotionFeedback], frozen=True, kw_only=True):
    """Execute a planned path from its start.

    Rejected when the arm is not at the start, or when the path is no longer free and adaptation is disabled.
    """

    capability: ClassVar[Capability] = "trajectory"

    plan: PlannedMotion
    adaptation: Adaptation = Adaptation()
    options: PlanOptions = PlanOptions()


class MoveFree(Action[FreeMotionResult, FreeMotionFeedback], frozen=True, kw_only=True):
    """Plan a collision-free path to `target` and execute it; `adaptation` defines the reaction to changes.

    Rejected with the reason when no path is possible; when only a person or another arm blocks every path,
    the goal is accepted and waits.
    """

    capability: ClassVar[Capability] = "trajectory"

    target: MotionTarget
    options: PlanOptions = PlanOptions()
    adaptation: Adaptation = Adaptation()


class PathPreview(Message, frozen=True, kw_only=True):
    """The path of an arm for the 3D view, the latest value of `<arm>/planned_path`.

    `joints` are configurations along the path, `tool_path` the tool centre at each of them, in the world.
    Empty when there is no path. `state` is `proposed` until the arm executes the path.
    """

    robot: str
    state: Literal["none", "proposed", "moving", "blocked"]
    joint_names: tuple[str, ...] = ()
    joints: tuple[tuple[float, ...], ...] = ()
    tool_path: tuple[Vector3, ...] = ()
    reason: str = ""
