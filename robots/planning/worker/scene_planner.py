"""Answers plan requests in this process: checks start and goal, runs the requested planner, validates every path."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TypeVar

import numpy as np

from engine.messages.sensing import OccupancyGrid
from engine.skills.planning_scene import FARTHEST_M, CollisionReport, TouchingPair
from engine.wording import did_you_mean
from robots.model.robot_model import RobotModel
from robots.planning.planner_names import FAST, PLANNERS, STOMP, UNAVAILABLE_PLANNERS
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    PairDistanceRequest,
    PairDistances,
    PathCheck,
    PathCheckRequest,
    PathGoal,
    PathPlan,
    PlanAnswer,
    PlanRefusal,
    PlanRequest,
    PlanStats,
)
from robots.planning.scene.compiled_problem import FREE, CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import PlanningScene
from robots.planning.scene.static_scene import arm_in_scene, with_tool_contact
from robots.planning.scene.voxels import VoxelCache
from robots.planning.search.attached_part_check import check_attached_parts
from robots.planning.search.endpoints import Endpoints, check_endpoints, validate_joints
from robots.planning.search.fast_search import (
    count_exact_checks,
    fast_search,
    shorten_path,
    warm_up,
    with_room_for,
    with_wider_gaps,
)
from robots.planning.search.kernels import blocked_at
from robots.planning.search.motion_check import check_motion
from robots.planning.search.ompl_search import ompl_search
from robots.planning.search.path_check import SelfCollisionCache, check_path
from robots.planning.search.path_validation import validate_path
from robots.planning.search.problem_compiler import ProblemNames, compile_problem, voxels_alone, with_voxels
from robots.planning.search.search_task import SearchAlgorithm, SearchBudget, SearchTask
from robots.planning.search.stomp import stomp_search
from robots.planning.search.swept_voxels import swept_space
from robots.planning.swept_space import SweptSpace, SweptSpaceRequest
from robots.planning.timing.trajectory_timing import time_path
from robots.port import Array, JointTrajectory
from robots.scene.sim_scene import ArmPlacement

_Result = TypeVar("_Result")

GIVEN_PATH = "given"
"""Value of `found_by` for a path that was given in the request."""

_CACHE_SIZE = 4
_ATTEMPTS = 4
# Share of the time for the fast planner, whose spheres are larger than the arm, before the exact one takes over.
_FAST_SHARE = 0.6
_FALL_BACK = "RRTConnect"
# Duration of a sphere check and of an exact check on the benchmark machine.
_FAST_CHECK_S, _EXACT_CHECK_S = 2e-6, 1.5e-5


@dataclass(frozen=True, kw_only=True)
class PlanningContext:
    """One arm in one scene, prepared for requests; its exact checker is made at its first use."""

    make_checker: Callable[[], ExactChecker]
    problem: CompiledProblem
    names: ProblemNames

    @cached_property
    def checker(self) -> ExactChecker:
        """Checks exactly."""
        return self.make_checker()


class ScenePlanner:
    """Answers requests one after the other; caches the contexts of the latest scenes.

    Args:
        check_s: Seconds charged for a check if the budget counts work, whatever the machine; None uses wall time.
    """

    def __init__(self, *, check_s: float | None = None) -> None:
        self._check_s = check_s
        self._warm = False
        self._models: dict[ArmPlacement, RobotModel] = {}
        self._voxels = VoxelCache()
        self._self_collision_cache = SelfCollisionCache()
        self.effort_s = 0.0
        """The duration of the counted work of the latest plan, independent of the machine."""
        self._contexts: OrderedDict[tuple[PlanningScene, str, float], PlanningContext] = OrderedDict()

    def plan(self, request: PlanRequest, *, cancelled: Callable[[], bool] = lambda: False) -> PlanAnswer:
        """Return a validated path, or why there is none; queries `cancelled` between work steps.

        Raises:
            CellError: the scene has no such arm, or is invalid.
        """
        if request.planner not in PLANNERS:
            return _unknown(request.planner)
        if request.planner == STOMP and request.keep_orientation is not None:
            return PlanRefusal(
                reason="unknown_planner", message="stomp cannot keep the tool's orientation", hint=f"use {FAST}"
            )
        self.effort_s = 0.0
        prepared = self.prepared(request.scene, request.arm, margin_m=request.margin_m, occupancy=request.occupancy)
        budget = SearchBudget(request.time_s, check_s=self._check_s, cancelled=cancelled)
        if isinstance(request.goal, PathGoal):
            given = validate_path(request, request.goal, prepared.checker, prepared.problem)
            if isinstance(given, PlanRefusal):
                return given
            attempt = _Attempt(request, prepared, given[1], budget)
            answer = attempt.given(given[0])
        else:
            ends = check_endpoints(request, prepared.checker, prepared.problem)
            if isinstance(ends, PlanRefusal):
                return ends
            attempt = _Attempt(request, prepared, ends, budget)
            answer = attempt.answer()
        self.effort_s = attempt.effort_s
        if isinstance(answer, PathPlan) and answer.timed is not None:
            self._self_collision_cache.add(request.scene, request.arm, answer.timed, 0.0)
        return answer

    def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return the first collision of an arm that follows a trajectory.

        Raises:
            CellError: the scene has no such arm or is invalid, or the trajectory does not fit the arm.
        """
        scene = request.scene
        if request.tool_contact == "along_path":
            scene = with_tool_contact(scene, request.arm, robot=self._robot)
        prepared = self.prepared(scene, request.arm, margin_m=request.margin_m, occupancy=request.occupancy)
        known = self._self_collision_cache
        if request.tool_contact is None:
            return check_path(request, prepared.checker, prepared.problem, known)
        return check_motion(request, lambda: prepared.checker, prepared.problem, known)

    def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return the first collision of an attached part on a trajectory; raises as `check_path` does."""
        return check_attached_parts(request, robot=self._robot)

    def look(self, request: CollisionRequest) -> CollisionReport:
        """Return the collisions and the clearance of an arm in a configuration.

        Raises:
            CellError: the scene has no such arm or is invalid, or the joints do not fit the arm.
        """
        checker = self.prepared(
            request.scene, request.arm, margin_m=request.margin_m, occupancy=request.occupancy
        ).checker
        joints = validate_joints(request.joints_rad, checker)
        nearest = checker.clearance(joints)
        return CollisionReport(
            touching=tuple(
                TouchingPair(first=a, second=b, depth_m=max(0.0, checker.depth(joints, frozenset((a, b)))))
                for a, b in checker.colliding_pairs(joints)
            ),
            distance_m=min(nearest.distance_m, FARTHEST_M),
            nearest=nearest.pair,
        )

    def pair_distances(self, request: PairDistanceRequest) -> PairDistances:
        """Return the distances of two bodies with an arm at several configurations; raises as `look` does."""
        checker = self.prepared(
            request.scene, request.arm, margin_m=request.margin_m, occupancy=request.occupancy
        ).checker
        rows = [validate_joints(row, checker) for row in request.rows_rad]
        first = {request.pair, *(pair for row in rows[:1] for pair in checker.colliding_pairs(row))}
        return PairDistances(
            distance_m=tuple(-checker.depth(row, frozenset(request.pair)) for row in rows),
            touches_another=tuple(not first.issuperset(checker.colliding_pairs(row)) for row in rows),
        )

    def swept_space(self, request: SweptSpaceRequest) -> SweptSpace:
        """Return the unknown space on a trajectory; raises as `check_path` does."""
        return swept_space(request, self.prepared(request.scene, request.arm).problem)

    def prepared(
        self, scene: PlanningScene, arm: str, *, margin_m: float = 0.0, occupancy: OccupancyGrid | None = None
    ) -> PlanningContext:
        """Return the context of an arm in a scene; raises CellError if the scene or the grid is invalid."""
        # The joints of the arm itself come with every request.
        scene = scene.with_joints(arm, ())
        key = (scene, arm, margin_m)
        context = self._contexts.pop(key, None)
        if context is None:
            among = arm_in_scene(scene, arm, robot=self._robot)
            problem, names = compile_problem(scene, arm, margin_m=margin_m, among=among)
            context = PlanningContext(
                make_checker=partial(ExactChecker, scene, arm, margin_m=margin_m, among=among),
                problem=problem,
                names=names,
            )
            if not self._warm:
                # Otherwise the first request would spend its budget on compilation.
                warm_up(problem)
                self._warm = True
        self._contexts[key] = context
        if len(self._contexts) > _CACHE_SIZE:
            self._contexts.popitem(last=False)
        voxels = self._voxels.of(occupancy)
        if voxels is None:
            return context
        problem, names = with_voxels(context.problem, context.names, scene, voxels, margin_m=margin_m)
        voxel_problem = voxels_alone(problem)
        # The spheres contain the arm: where they touch no voxel, the arm does not either.

        def seeing() -> ExactChecker:
            return context.checker.seeing(voxels, may_meet=lambda joints: blocked_at(voxel_problem, joints[None]) >= 0)

        return PlanningContext(make_checker=seeing, problem=problem, names=names)

    def _robot(self, placement: ArmPlacement) -> RobotModel:
        """Return the cached model of an arm: the arms of a cell do not change."""
        if placement not in self._models:
            self._models[placement] = placement.robot()
        return self._models[placement]


class _Attempt:
    """The planning of one request."""

    def __init__(self, request: PlanRequest, prepared: PlanningContext, ends: Endpoints, budget: SearchBudget) -> None:
        self._request = request
        self._prepared = prepared
        self._ends = ends
        self._budget = budget
        self._spent = {"search": 0.0, "shortening": 0.0, "verification": 0.0, "timing": 0.0}
        self._exact_checks = 0
        self._fast_checks = 0
        self._refused = 0

    def answer(self) -> PlanAnswer:
        name = self._request.planner
        if name == FAST:
            path = self._fast()
            if path is None and not self._budget.over:
                name, path = _FALL_BACK, self._by_name(_FALL_BACK)
        else:
            path = self._by_name(name)
        if path is None:
            return self._refusal()
        return self._plan(np.vstack((self._ends.lead, path)), name)

    def given(self, path: Array) -> PathPlan:
        """Return the plan for a path that is already validated."""
        self._exact_checks += count_exact_checks(self._prepared.checker, path)
        return self._plan(path, GIVEN_PATH)

    @property
    def effort_s(self) -> float:
        """The duration of the counted work so far."""
        exact = self._exact_checks + self._budget.checks - self._fast_checks
        return self._fast_checks * _FAST_CHECK_S + exact * _EXACT_CHECK_S

    def _plan(self, path: Array, name: str) -> PathPlan:
        timed = None
        if self._request.speed is not None:
            timed = self._timed("timing", lambda w=path, v=self._request.speed: self._trajectory(w, v))
        stats = PlanStats(
            search_s=self._spent["search"],
            shortening_s=self._spent["shortening"],
            verification_s=self._spent["verification"],
            timing_s=self._spent["timing"],
            checks=self._budget.checks,
            exact_checks=self._exact_checks,
            refused_paths=self._refused,
            found_by=name,
        )
        rows: list[list[float]] = path.tolist()
        return PathPlan(waypoints_rad=tuple(tuple(row) for row in rows), stats=stats, timed=timed)

    def _fast(self) -> Array | None:
        """Return a validated path of the fast planner; paths that the exact check rejects widen the gaps."""
        problem = self._ends.problem
        known_free = np.vstack((self._ends.start, self._ends.goals))
        share = SearchBudget(
            self._budget.left_s * _FAST_SHARE,
            check_s=None if self._budget.is_wall_clock else 1e-6,
            cancelled=lambda: self._budget.cancelled,
        )
        path = None
        for attempt in range(_ATTEMPTS):
            path = self._timed("search", lambda p=problem, a=attempt: fast_search(self._task(p, a), share))
            if path is None:
                break
            path = self._timed(
                "shortening", lambda p=problem, w=path: shorten_path(p, w, seed=self._request.seed, budget=share)
            )
            hit = self._timed("verification", lambda w=path: self._prepared.checker.first_collision(w))
            self._exact_checks += count_exact_checks(self._prepared.checker, path)
            if hit is None:
                break
            self._refused += 1
            path = None
            problem = with_room_for(with_wider_gaps(problem, self._prepared.names, hit), known_free)
        self._fast_checks += share.checks
        self._budget.spend(share.checks)
        return path

    def _by_name(self, name: str) -> Array | None:
        """Return a validated path of STOMP or of an OMPL planner."""
        search: SearchAlgorithm = stomp_search if name == STOMP else ompl_search(name)
        for attempt in range(_ATTEMPTS):
            path = self._timed("search", lambda a=attempt: search(self._task(self._ends.problem, a), self._budget))
            if name == STOMP:
                self._fast_checks = self._budget.checks
            if path is None:
                return None
            path = self._timed("shortening", lambda w=path: self._shorter(w))
            hit = self._timed("verification", lambda w=path: self._prepared.checker.first_collision(w))
            self._exact_checks += count_exact_checks(self._prepared.checker, path)
            if hit is None and self._keeps_orientation(path):
                return path
            self._refused += 1
            if self._budget.over:
                return None
        return None

    def _shorter(self, path: Array) -> Array:
        """Return the path, shortened where the spheres are free; OMPL also finds paths where they are not."""
        problem = with_room_for(self._ends.problem, path[1:-1])
        shorter = shorten_path(problem, path, seed=self._request.seed, budget=self._budget)
        return shorter if self._prepared.checker.first_collision(shorter) is None else path

    def _trajectory(self, path: Array, speed: float) -> JointTrajectory:
        checker = self._prepared.checker
        timed = time_path(
            path,
            limits=checker.model.limits,
            is_free=lambda piece: checker.first_collision(piece) is None and self._keeps_orientation(piece),
            speed=speed,
        )
        return timed.trajectory

    def _keeps_orientation(self, path: Array) -> bool:
        problem = self._ends.problem
        if problem.orientation == FREE:
            return True
        only = problem._replace(
            solid_gap=np.full_like(problem.solid_gap, -np.inf), pair_gap=np.full_like(problem.pair_gap, -np.inf)
        )
        return blocked_at(only, path) < 0

    def _task(self, problem: CompiledProblem, attempt: int) -> SearchTask:
        return SearchTask(
            start=self._ends.start,
            goals=self._ends.goals,
            problem=problem,
            checker=self._prepared.checker,
            seed=self._request.seed + 7919 * attempt,
        )

    def _timed(self, what: str, work: Callable[[], _Result]) -> _Result:
        start = time.perf_counter()
        result = work()
        self._spent[what] += time.perf_counter() - start
        return result

    def _refusal(self) -> PlanRefusal:
        if self._budget.cancelled:
            return PlanRefusal(reason="cancelled", message="the plan request was canceled")
        effort = f"{self._budget.checks} configurations checked, {self._refused} paths rejected by the exact check"
        request = self._request
        asked = f" with a margin of {request.margin_m * 1e3:g} mm" if request.margin_m > 0.0 else ""
        if request.keep_orientation is not None:
            asked += f", the tool turned by at most {request.keep_orientation.tolerance_rad:g} rad"
        return PlanRefusal(
            reason="no_path_in_time",
            message=f"{request.planner} found no path within {request.time_s:g} s{asked} ({effort})",
            hint="allow more time, choose another planner, or remove obstacles"
            + (", or ask for less" if asked else ""),
        )


def _unknown(name: str) -> PlanRefusal:
    message = f"unknown planner {name}"
    if name.upper() in UNAVAILABLE_PLANNERS:
        message = f"the installed Python package of OMPL does not provide {name.upper()}"
    return PlanRefusal(
        reason="unknown_planner",
        message=message,
        hint=f"{did_you_mean(name, PLANNERS) or ''} available: {', '.join(PLANNERS)}".strip(),
    )
