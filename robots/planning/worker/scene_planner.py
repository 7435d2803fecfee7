"""Answers plan requests in this process: checks start and goal, runs the planner asked for, confirms every way."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from engine.messages.sensing import OccupancyGrid
from engine.skills.planning_scene import FARTHEST_M, CollisionReport, TouchingPair
from engine.suggestions import did_you_mean
from robots.model.robot_model import RobotModel
from robots.planning.planner_names import FAST, PLANNERS, STOMP, UNAVAILABLE_PLANNERS
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    PathCheck,
    PathCheckRequest,
    PathGoal,
    PathPlan,
    PlanAnswer,
    PlanRefusal,
    PlanRequest,
    PlanStats,
    SampledTrajectory,
)
from robots.planning.scene.compiled_problem import FREE, CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import PlanningScene
from robots.planning.scene.static_scene import arm_in_scene
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
from robots.planning.search.ompl_search import ompl_search
from robots.planning.search.path_check import SelfCollisionCache, check_path
from robots.planning.search.path_validation import validate_path
from robots.planning.search.problem_compiler import ProblemNames, compile_problem, voxels_alone, with_voxels
from robots.planning.search.search_task import SearchAlgorithm, SearchBudget, SearchTask
from robots.planning.search.stomp import stomp_search
from robots.planning.timing.trajectory_timing import time_path
from robots.port import Array, JointTrajectory
from robots.sim.scene.sim_scene import ArmPlacement

_Result = TypeVar("_Result")

GIVEN_PATH = "given"
"""Who found a way that came with the request."""

_KEPT = 4
_ATTEMPTS = 4
# Share of the time after which the fast planner, whose spheres are larger than the arm, gives way to the exact one.
_FAST_SHARE = 0.6
_FALL_BACK = "RRTConnect"
# What a look of the spheres, and one of the exact checker, takes on the machine of the benchmark.
_FAST_CHECK_S, _EXACT_CHECK_S = 2e-6, 1.5e-5


@dataclass(frozen=True, kw_only=True)
class PlanningContext:
    """One arm in one scene, ready for requests."""

    checker: ExactChecker
    problem: CompiledProblem
    names: ProblemNames


class ScenePlanner:
    """Answers requests one after the other; keeps what it prepared for the latest scenes.

    Args:
        check_s: What a check counts as when time is to be counted by work done, so that answers repeat
            whatever the machine does; None goes by the clock.
    """

    def __init__(self, *, check_s: float | None = None) -> None:
        self._check_s = check_s
        self._warm = False
        self._models: dict[ArmPlacement, RobotModel] = {}
        self._voxels = VoxelCache()
        self._own_ways = SelfCollisionCache()
        self.effort_s = 0.0
        """The time that the counted work of the latest plan stands for, whatever the machine."""
        self._kept: OrderedDict[tuple[PlanningScene, str, float], PlanningContext] = OrderedDict()

    def plan(self, request: PlanRequest, *, cancelled: Callable[[], bool] = lambda: False) -> PlanAnswer:
        """Return a confirmed way, or why there is none; `cancelled` is asked between pieces of work.

        Raises:
            CellError: the scene has no such arm, or something in it is wrong.
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
            self._own_ways.add(request.scene, request.arm, answer.timed, 0.0)
        return answer

    def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return where an arm that follows a trajectory would touch something first.

        Raises:
            CellError: the scene has no such arm, something in it is wrong, or the way is not this arm's.
        """
        prepared = self.prepared(request.scene, request.arm, margin_m=request.margin_m, occupancy=request.occupancy)
        return check_path(request, prepared.checker, prepared.problem, self._own_ways)

    def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return where what an arm holds would touch something first on a trajectory; raises as `check_path` does."""
        return check_attached_parts(request, robot=self._robot)

    def look(self, request: CollisionRequest) -> CollisionReport:
        """Return what an arm touches in a configuration and how near it is to what it must not touch.

        Raises:
            CellError: the scene has no such arm, something in it is wrong, or the joints are not this arm's.
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

    def prepared(
        self, scene: PlanningScene, arm: str, *, margin_m: float = 0.0, occupancy: OccupancyGrid | None = None
    ) -> PlanningContext:
        """Return what checks and plans for an arm in a scene; raises CellError when the scene or the grid is wrong."""
        # Where the arm is itself, is asked about with every request.
        scene = scene.with_joints(arm, ())
        key = (scene, arm, margin_m)
        found = self._kept.pop(key, None)
        if found is None:
            among = arm_in_scene(scene, arm, robot=self._robot)
            problem, names = compile_problem(scene, arm, margin_m=margin_m, among=among)
            checker = ExactChecker(scene, arm, margin_m=margin_m, among=among)
            found = PlanningContext(checker=checker, problem=problem, names=names)
            if not self._warm:
                # Else the first request would spend its time on compiling.
                warm_up(problem)
                self._warm = True
        self._kept[key] = found
        if len(self._kept) > _KEPT:
            self._kept.popitem(last=False)
        voxels = self._voxels.of(occupancy)
        if voxels is None:
            return found
        problem, names = with_voxels(found.problem, found.names, scene, voxels, margin_m=margin_m)
        seen = voxels_alone(problem)
        # The spheres hold all of the arm: where they meet no voxel, the arm does not.
        checker = found.checker.seeing(voxels, may_meet=lambda joints: blocked_at(seen, joints[None]) >= 0)
        return PlanningContext(checker=checker, problem=problem, names=names)

    def _robot(self, placement: ArmPlacement) -> RobotModel:
        """Return the model of an arm as it was when it was first met: what stands in the cell does not change."""
        found = self._models.get(placement)
        if found is None:
            found = self._models[placement] = placement.robot()
        return found


class _Attempt:
    """One request under way."""

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
            found = self._fast()
            if found is None and not self._budget.over:
                name, found = _FALL_BACK, self._by_name(_FALL_BACK)
        else:
            found = self._by_name(name)
        if found is None:
            return self._nothing()
        return self._plan(np.vstack((self._ends.lead, found)), name)

    def given(self, path: Array) -> PathPlan:
        """Return the plan that a way is that was confirmed already."""
        self._exact_checks += count_exact_checks(self._prepared.checker, path)
        return self._plan(path, GIVEN_PATH)

    @property
    def effort_s(self) -> float:
        """The time that the work so far stands for."""
        exact = self._exact_checks + self._budget.checks - self._fast_checks
        return self._fast_checks * _FAST_CHECK_S + exact * _EXACT_CHECK_S

    def _plan(self, found: Array, name: str) -> PathPlan:
        way = None
        if self._request.speed is not None:
            trajectory = self._timed("timing", lambda w=found, v=self._request.speed: self._trajectory(w, v))
            way = SampledTrajectory.of(trajectory)
        stats = PlanStats(
            search_s=self._spent["search"],
            shortening_s=self._spent["shortening"],
            verification_s=self._spent["verification"],
            timing_s=self._spent["timing"],
            checks=self._budget.checks,
            exact_checks=self._exact_checks,
            refused_ways=self._refused,
            found_by=name,
        )
        rows: list[list[float]] = found.tolist()
        return PathPlan(waypoints_rad=tuple(tuple(row) for row in rows), stats=stats, timed=way)

    def _fast(self) -> Array | None:
        """Return a confirmed way of the fast planner; what the exact check refuses teaches the next attempt."""
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
        """Return a confirmed way of STOMP or of a planner of OMPL."""
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
        """Return the way shortened where the spheres allow that; OMPL finds ways where they do not."""
        problem = with_room_for(self._ends.problem, path[1:-1])
        shorter = shorten_path(problem, path, seed=self._request.seed, budget=self._budget)
        return shorter if self._prepared.checker.first_collision(shorter) is None else path

    def _trajectory(self, path: Array, speed: float) -> JointTrajectory:
        checker = self._prepared.checker
        way = time_path(
            path,
            limits=checker.model.limits,
            is_free=lambda piece: checker.first_collision(piece) is None and self._keeps_orientation(piece),
            speed=speed,
        )
        return way.trajectory

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

    def _nothing(self) -> PlanRefusal:
        if self._budget.cancelled:
            return PlanRefusal(reason="cancelled", message="the plan is no longer wanted")
        looked = f"{self._budget.checks} configurations looked at, {self._refused} ways refused by the exact check"
        return PlanRefusal(
            reason="no_path_in_time",
            message=f"{self._request.planner} found no path within {self._request.time_s:g} s ({looked})",
            hint="give it more time, another planner, or clear the way",
        )


def _unknown(name: str) -> PlanRefusal:
    message = f"no planner is called {name}"
    if name.upper() in UNAVAILABLE_PLANNERS:
        message = f"the installed OMPL gives Python no {name.upper()}"
    return PlanRefusal(
        reason="unknown_planner",
        message=message,
        hint=f"{did_you_mean(name, PLANNERS) or ''} there are {', '.join(PLANNERS)}".strip(),
    )
