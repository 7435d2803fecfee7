"""Collision-free motion of one arm, answered under the arm's name: plan, execute a plan, move free of collisions.

Plans take the planning scene of the cell (see `planning_scene`) and what the cameras see of it. A motion that
adapts looks at everything that changes while it is under way: where a collision is predicted the arm
decelerates, looks for another way from where it stands and goes on; without one it waits until there is.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages import Message, Pose, Vector3
from engine.skill import Action
from engine.skills.motion import PoseMatch, Speed

PlannerName = Annotated[
    str,
    msgspec.Meta(
        description="`fast`, `stomp`, or a planner of OMPL such as `RRTConnect`, `RRT`, `PRM`, `KPIECE1`",
        extra_json_schema={"cell_name": "planner"},
    ),
]
PlanningTime = Annotated[
    float, msgspec.Meta(gt=0.0, le=60.0, description="Longest search for a way", extra_json_schema={"unit": "s"})
]
Margin = Annotated[
    float,
    msgspec.Meta(ge=0.0, le=0.2, description="Least distance from obstacles", extra_json_schema={"unit": "m"}),
]
BlockedPathTimeout = Annotated[
    float,
    msgspec.Meta(ge=0.0, le=3600.0, description="Longest wait for a free way", extra_json_schema={"unit": "s"}),
]
Tilt = Annotated[
    float, msgspec.Meta(gt=0.0, le=3.2, description="Greatest turn of the tool", extra_json_schema={"unit": "rad"})
]

MotionPhase = Literal["planning", "moving", "braking", "waiting"]


class KeepOrientation(Message, frozen=True, kw_only=True):
    """The tool keeps the orientation that it has at the start, within a tolerance.

    With `free_about`, a direction in the frame of the tool, it may turn about that: a full cup has (0, 0, 1).
    """

    tolerance_rad: Tilt = 0.1
    free_about: Vector3 | None = None


class MotionTarget(Message, frozen=True, kw_only=True):
    """Where to: either `joints` (radians) or `pose` of the tool centre point, of which `match` says what counts."""

    joints: tuple[float, ...] = ()
    pose: Pose | None = None
    match: PoseMatch = "pose"


class PlanOptions(Message, frozen=True, kw_only=True):
    """Options of a planning request: planner, time limit, seed, distance from obstacles, speed."""

    planner: PlannerName = "fast"
    time_s: PlanningTime = 1.0
    seed: int = 0
    margin_m: Margin = 0.0
    keep_orientation: KeepOrientation | None = None
    speed: Speed = 0.3


class PlannedMotion(Message, frozen=True, kw_only=True):
    """A way that was found free of collisions: waypoints joined by straight joint lines, the first one the start.

    Who goes it rounds its corners and times it for `speed`, which takes `duration_s`. `tool_path` are points of
    the tool centre along the way, in the world, for drawing. `found_by` is the planner that found it,
    `planning_s` what finding, shortening, confirming and timing took.
    """

    robot: str
    waypoints: tuple[tuple[float, ...], ...]
    speed: Speed
    duration_s: float
    tool_path: tuple[Vector3, ...]
    found_by: str
    planning_s: float


class PlanFeedback(Message, frozen=True, kw_only=True):
    """The search goes on."""

    elapsed_s: float


class PlanMotion(Action[PlannedMotion, PlanFeedback], frozen=True, kw_only=True):
    """Plan a collision-free path to `target` and publish it; the arm is not commanded and may be moving.

    From `start` (radians), or from where the arm is set to stand where it is empty. Fails with the reason: what
    is touched at the start or at the goal, that the arm does not reach the goal, or that no way was found.
    """

    target: MotionTarget
    start: tuple[float, ...] = ()
    options: PlanOptions = PlanOptions()


class FreeMotionFeedback(Message, frozen=True, kw_only=True):
    """What a collision-free motion does: `progress` along the present way, 0 to 1, and why it brakes or waits.

    `replans` counts new ways found on the way, `waited_s` the time without one.
    """

    phase: MotionPhase
    joints: tuple[float, ...]
    progress: float
    replans: int
    waited_s: float
    reason: str = ""


class FreeMotionResult(Message, frozen=True, kw_only=True):
    """The measured configuration at the end, radians, and what it took to get there.

    `stops` counts how often the arm stopped before a predicted collision, `replans` how often it went on along
    another way, `reused` how often along the old one because that was free again. A motion that was given up
    because its way stayed blocked for longer than its patience says in `blocked` by what; else that is empty.
    """

    joints: tuple[float, ...]
    duration_s: float
    stops: int
    replans: int
    reused: int
    waited_s: float
    blocked: str = ""


class Adaptation(Message, frozen=True, kw_only=True):
    """What to do about changes on the way: look out for them, and how long to wait where there is no other way.

    Without `watch` the arm goes its way whatever appears in it. With `patience_s` 0 it does not wait: it fails
    with the reason, at rest.
    """

    watch: bool = True
    patience_s: BlockedPathTimeout = 60.0


class ExecutePlan(Action[FreeMotionResult, FreeMotionFeedback], frozen=True, kw_only=True):
    """Execute a path that was planned before, from its start.

    Rejected where the arm stands elsewhere, or where the way is no longer free and nothing may be adapted.
    """

    plan: PlannedMotion
    adaptation: Adaptation = Adaptation()
    options: PlanOptions = PlanOptions()


class MoveFree(Action[FreeMotionResult, FreeMotionFeedback], frozen=True, kw_only=True):
    """Plan a collision-free path to `target` and execute it; `Adaptation` says what happens on the path.

    Rejected with the reason where there is none and none will be; where only somebody, or another arm, is in
    every way, it is accepted and waits.
    """

    target: MotionTarget
    options: PlanOptions = PlanOptions()
    adaptation: Adaptation = Adaptation()


class PathPreview(Message, frozen=True, kw_only=True):
    """The way of an arm as the 3D view shows it, the latest value of `<arm>/planned_path`.

    `joints` are configurations along the way, `tool_path` the tool centre at each of them, in the world.
    Empty when there is nothing to show. `state` is `proposed` until the arm goes the way.
    """

    robot: str
    state: Literal["none", "proposed", "moving", "blocked"]
    joint_names: tuple[str, ...] = ()
    joints: tuple[tuple[float, ...], ...] = ()
    tool_path: tuple[Vector3, ...] = ()
    reason: str = ""
