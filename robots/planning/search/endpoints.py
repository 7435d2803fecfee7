"""Exact checks of the start and goals of a plan: within limits and collision-free, else the reason."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.errors import CellError, RobotError
from engine.messages import Pose
from robots.model.inverse_kinematics import InverseKinematicsSolver, PoseMatch
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.planning.request import JointGoal, PathGoal, PathOrientationConstraint, PlanRefusal, PlanRequest, PoseGoal
from robots.planning.scene.compiled_problem import FREE, FULL, TILT, CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import NamePair
from robots.planning.search.escape import EscapeChecker, escape_configuration
from robots.planning.search.fast_search import tilt_at, with_room_for
from robots.planning.search.kernels import tool_rotation
from robots.port import Array

_MOST_GOALS = 12
_BEYOND_RAD = 1e-6


@dataclass(frozen=True, kw_only=True)
class Endpoints:
    """A free start (n,) and free goals (k, n), nearest first; in `problem` the spheres are free there as well.

    `lead` (k, n) are the waypoints before the start: the arm's configuration if it is within the margin of an
    object, else none.
    """

    lead: Array
    start: Array
    goals: Array
    problem: CompiledProblem


def check_endpoints(request: PlanRequest, checker: ExactChecker, problem: CompiledProblem) -> Endpoints | PlanRefusal:
    """Return the endpoints of a request, or why there can be no path between them."""
    start = np.array(request.start_rad, dtype=np.float64)
    outside = outside_limits(start, problem, checker)
    if outside:
        return PlanRefusal(
            reason="start_outside_limits", message=f"the start: {outside}", hint="move the arm within its limits first"
        )
    escape = EscapeChecker(checker, start)
    if escape.in_collision(start):
        touching = describe_collision(checker, start, pairs := escape.colliding_pairs(start))
        return _start_collision(touching, pairs, hint="guide the arm away by hand, or allow this contact")
    if request.keep_orientation is not None:
        problem = with_upright_tool(problem, start, request.keep_orientation)
    goals = _goals(request, checker, problem, start)
    if isinstance(goals, PlanRefusal):
        return goals
    lead = np.empty((0, len(start)))
    if escape.within_margin:
        outside_start = escape_configuration(checker, problem, start, goals, seed=request.seed)
        if outside_start is None:
            pairs = checker.colliding_pairs(start)
            near = describe_collision(checker, start, pairs)
            return _start_collision(
                near, pairs, hint=f"no path leaves the margin of {request.margin_m:g} m; reduce the margin"
            )
        lead, start = start[None], outside_start
    return Endpoints(lead=lead, start=start, goals=goals, problem=with_room_for(problem, np.vstack((start, goals))))


def _start_collision(what: str, pairs: tuple[NamePair, ...], *, hint: str) -> PlanRefusal:
    return PlanRefusal(reason="start_in_collision", message=f"at the start {what}", hint=hint, pairs=pairs)


def _goals(request: PlanRequest, checker: ExactChecker, problem: CompiledProblem, start: Array) -> Array | PlanRefusal:
    candidates = _goal_configurations(request, checker, problem, start)
    if isinstance(candidates, PlanRefusal):
        return candidates
    free: list[Array] = []
    pairs: tuple[NamePair, ...] = ()
    what = ""
    tilt = np.inf
    for joints in candidates[np.argsort(np.abs(candidates - start).max(axis=1), kind="stable")]:
        if problem.orientation != FREE:
            angle = tilt_at(problem, joints)
            tilt = min(tilt, angle)
            if angle > problem.tolerance:
                continue
        if not checker.in_collision(joints):
            free.append(joints)
            if len(free) == _MOST_GOALS:
                break
        elif not pairs:
            pairs = checker.colliding_pairs(joints)
            what = describe_collision(checker, joints, pairs)
    if free:
        return np.array(free)
    if pairs:
        return PlanRefusal(
            reason="goal_in_collision",
            message=f"at the goal {what}"
            + (f" (and {len(candidates) - 1} more goals in collision)" if len(candidates) > 1 else ""),
            hint="choose another goal, allow this contact, or reduce the margin"
            if request.margin_m > 0.0
            else "choose another goal, or allow this contact",
            pairs=pairs,
        )
    return PlanRefusal(
        reason="goal_unreachable",
        message=f"at the goal the tool is rotated by {tilt:.3f} rad, the path allows {problem.tolerance:g} rad",
        hint="start with the tool orientation of the goal",
    )


def _goal_configurations(
    request: PlanRequest, checker: ExactChecker, problem: CompiledProblem, start: Array
) -> Array | PlanRefusal:
    """Return the goal configurations (k, n) within the limits."""
    match request.goal:
        case PathGoal():
            raise ValueError("a given path has no goal to search for")
        case JointGoal(joints_rad=rows):
            kept: list[Array] = []
            reason = "no goal is given"
            for row in rows:
                joints = np.array(row, dtype=np.float64)
                outside = outside_limits(joints, problem, checker)
                if outside:
                    reason = outside
                else:
                    kept.append(joints)
            if kept:
                return np.array(kept)
            return PlanRefusal(reason="goal_outside_limits", message=f"the goal: {reason}", hint="choose another goal")
        case PoseGoal(pose=pose, match=match):
            return _solutions(request, checker, pose, PoseMatch[match.upper()], start)


def _solutions(
    request: PlanRequest, checker: ExactChecker, pose: Pose, match: PoseMatch, start: Array
) -> Array | PlanRefusal:
    base = RigidTransform.from_pose(request.scene.arm(request.arm).placement.base)
    tool = RigidTransform.from_pose(request.tool) if request.tool is not None else None
    inverse = InverseKinematicsSolver(ArmKinematics(checker.model, base=base, tool=tool))
    try:
        return inverse.all_solutions(RigidTransform.from_pose(pose), seed=start, match=match).joints
    except (RobotError, ValueError) as error:
        message = error.message if isinstance(error, RobotError) else str(error)
        hint = error.hint or "" if isinstance(error, RobotError) else ""
        return PlanRefusal(reason="goal_unreachable", message=message, hint=hint)


def with_upright_tool(problem: CompiledProblem, start: Array, constraint: PathOrientationConstraint) -> CompiledProblem:
    """Return the problem in which the tool keeps its orientation at `start` (n,)."""
    tool = tool_rotation(problem, start)
    if constraint.free_about is None:
        return problem._replace(
            orientation=FULL, upright=np.vstack((tool, (0.0, 0.0, 1.0))), tolerance=constraint.tolerance_rad
        )
    axis = np.array(constraint.free_about) / np.linalg.norm(constraint.free_about)
    upright = np.vstack((np.eye(3), axis))
    upright[:3, 2] = tool @ axis
    return problem._replace(orientation=TILT, upright=upright, tolerance=constraint.tolerance_rad)


def outside_limits(joints: Array, problem: CompiledProblem, checker: ExactChecker) -> str:
    """Return a text on the joint farthest outside its limits at `joints` (n,), empty if none is."""
    lower, upper = problem.limits[0], problem.limits[1]
    if joints.shape != lower.shape or not np.isfinite(joints).all():
        return f"{joints.tolist()} is not a configuration of an arm with {len(lower)} joints"
    beyond = np.maximum(lower - joints, joints - upper)
    worst = int(np.argmax(beyond))
    if beyond[worst] <= _BEYOND_RAD:
        return ""
    name = checker.model.arm_joints[worst]
    return f"{name} at {joints[worst]:.4f} rad is outside {lower[worst]:.4f} … {upper[worst]:.4f}"


def validate_joints(joints_rad: tuple[float, ...], checker: ExactChecker) -> Array:
    """Return a configuration (n,); raises CellError if it does not fit this arm."""
    joints = np.array(joints_rad, dtype=np.float64)
    if joints.shape != (checker.dof,) or not np.isfinite(joints).all():
        raise CellError(
            f"{list(joints_rad)} is not a configuration", where=checker.arm, hint=f"give {checker.dof} joints"
        )
    return joints


def describe_touching(pairs: tuple[NamePair, ...]) -> str:
    """Return a text on the touching pairs, naming the first three."""
    return _listed([f"{a} touches {b}" for a, b in pairs[:3]], len(pairs))


def describe_collision(checker: ExactChecker, joints: Array, pairs: tuple[NamePair, ...]) -> str:
    """Return a text on colliding pairs at `joints` (n,); of what is only within the margin, distance and margin."""
    if checker.margin_m <= 0.0:
        return describe_touching(pairs)
    lines: list[str] = []
    for a, b in pairs[:3]:
        apart_m = -checker.depth(joints, frozenset((a, b)))
        near = f"is {apart_m * 1e3:.1f} mm from {b}, nearer than the margin of {checker.margin_m * 1e3:g} mm"
        lines.append(f"{a} {near}" if apart_m > 0.0 else f"{a} touches {b}")
    return _listed(lines, len(pairs))


def _listed(lines: list[str], count: int) -> str:
    return ", ".join(lines) + (f" and {count - len(lines)} more" if count > len(lines) else "")
