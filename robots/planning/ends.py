"""The two ends of a plan: start and goals within limits and free, exactly; or the reason why not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.errors import RobotError
from engine.messages import Pose
from robots.model.inverse_kinematics import InverseKinematics, Match
from robots.model.kinematics import ArmKinematics
from robots.model.rigid import Rigid
from robots.planning.exact_checker import ExactChecker
from robots.planning.fast_search import tilt_at, with_room_for
from robots.planning.kernels import tool_rotation
from robots.planning.problem import FREE, FULL, TILT, Problem
from robots.planning.request import JointGoal, KeepOrientation, PlanRequest, PoseGoal, Refusal
from robots.planning.scene import NamePair
from robots.port import Array

_MOST_GOALS = 12
_BEYOND_RAD = 1e-6


@dataclass(frozen=True, kw_only=True)
class Ends:
    """A start (n,) and goals (k, n), nearest first, that are free; the problem in which the spheres agree to that."""

    start: Array
    goals: Array
    problem: Problem


def checked_ends(request: PlanRequest, checker: ExactChecker, problem: Problem) -> Ends | Refusal:
    """Return the ends of a request, or why there is no way between them at all."""
    start = np.array(request.start_rad, dtype=np.float64)
    outside = _outside(start, problem, checker)
    if outside:
        return Refusal(reason="start_outside_limits", message=f"the start: {outside}", hint="move the arm back first")
    if checker.in_collision(start):
        pairs = checker.colliding_pairs(start)
        return Refusal(
            reason="start_in_collision",
            message=f"at the start {_words(pairs)}",
            hint="move the arm free by hand, or allow the pair to touch",
            pairs=pairs,
        )
    if request.keep_orientation is not None:
        problem = _kept_upright(problem, start, request.keep_orientation)
    goals = _goals(request, checker, problem, start)
    if isinstance(goals, Refusal):
        return goals
    return Ends(start=start, goals=goals, problem=with_room_for(problem, np.vstack((start, goals))))


def _goals(request: PlanRequest, checker: ExactChecker, problem: Problem, start: Array) -> Array | Refusal:
    found = _wanted(request, checker, problem, start)
    if isinstance(found, Refusal):
        return found
    free: list[Array] = []
    pairs: tuple[NamePair, ...] = ()
    tilt = np.inf
    for joints in found[np.argsort(np.abs(found - start).max(axis=1), kind="stable")]:
        if problem.orientation != FREE:
            turned = tilt_at(problem, joints)
            tilt = min(tilt, turned)
            if turned > problem.tolerance:
                continue
        if not checker.in_collision(joints):
            free.append(joints)
            if len(free) == _MOST_GOALS:
                break
        elif not pairs:
            pairs = checker.colliding_pairs(joints)
    if free:
        return np.array(free)
    if pairs:
        return Refusal(
            reason="goal_in_collision",
            message=f"at the goal {_words(pairs)}" + (f" (and at {len(found) - 1} more)" if len(found) > 1 else ""),
            hint="choose another goal, or allow the pair to touch",
            pairs=pairs,
        )
    return Refusal(
        reason="goal_unreachable",
        message=f"at the goal the tool is turned by {tilt:.3f} rad, {problem.tolerance:g} are allowed on the way",
        hint="start with the tool as it is at the goal",
    )


def _wanted(request: PlanRequest, checker: ExactChecker, problem: Problem, start: Array) -> Array | Refusal:
    """Return the configurations (k, n) that are a goal, within the limits."""
    match request.goal:
        case JointGoal(joints_rad=rows):
            kept: list[Array] = []
            reason = "no goal is given"
            for row in rows:
                joints = np.array(row, dtype=np.float64)
                outside = _outside(joints, problem, checker)
                if outside:
                    reason = outside
                else:
                    kept.append(joints)
            if kept:
                return np.array(kept)
            return Refusal(reason="goal_outside_limits", message=f"the goal: {reason}", hint="choose another goal")
        case PoseGoal(pose=pose, match=match):
            return _solutions(request, checker, pose, Match[match.upper()], start)


def _solutions(request: PlanRequest, checker: ExactChecker, pose: Pose, match: Match, start: Array) -> Array | Refusal:
    base = Rigid.from_pose(request.scene.arm(request.arm).placement.base)
    tool = Rigid.from_pose(request.tool) if request.tool is not None else None
    inverse = InverseKinematics(ArmKinematics(checker.model, base=base, tool=tool))
    try:
        return inverse.all_solutions(Rigid.from_pose(pose), seed=start, match=match).joints
    except (RobotError, ValueError) as error:
        message = error.message if isinstance(error, RobotError) else str(error)
        hint = error.hint or "" if isinstance(error, RobotError) else ""
        return Refusal(reason="goal_unreachable", message=message, hint=hint)


def _kept_upright(problem: Problem, start: Array, wish: KeepOrientation) -> Problem:
    tool = tool_rotation(problem, start)
    if wish.free_about is None:
        return problem._replace(
            orientation=FULL, upright=np.vstack((tool, (0.0, 0.0, 1.0))), tolerance=wish.tolerance_rad
        )
    axis = np.array(wish.free_about) / np.linalg.norm(wish.free_about)
    upright = np.vstack((np.eye(3), axis))
    upright[:3, 2] = tool @ axis
    return problem._replace(orientation=TILT, upright=upright, tolerance=wish.tolerance_rad)


def _outside(joints: Array, problem: Problem, checker: ExactChecker) -> str:
    lower, upper = problem.limits[0], problem.limits[1]
    if joints.shape != lower.shape or not np.isfinite(joints).all():
        return f"{joints.tolist()} is no configuration of an arm with {len(lower)} joints"
    beyond = np.maximum(lower - joints, joints - upper)
    worst = int(np.argmax(beyond))
    if beyond[worst] <= _BEYOND_RAD:
        return ""
    name = checker.model.arm_joints[worst]
    return f"{name} at {joints[worst]:.4f} rad is outside {lower[worst]:.4f} … {upper[worst]:.4f}"


def _words(pairs: tuple[NamePair, ...]) -> str:
    shown = ", ".join(f"{a} touches {b}" for a, b in pairs[:3])
    return shown + (f" and {len(pairs) - 3} more" if len(pairs) > 3 else "")
