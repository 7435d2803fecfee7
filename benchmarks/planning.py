"""Measures planning: `python -P benchmarks/planning.py [--runs N] [--scenes N] [--problems FILE] [--json FILE]`.

Prints the documents' experiments with all planners beside the documents' figures; random scenes of a Panda
with shelf, table and clutter, ours beside OMPL with the same exact checker and beside RoboPlan, where that is
installed; the problems of MotionBenchMaker, where a file of them is given (`planning_problems`); what scenes,
trajectories, voxels and checks of paths cost; and how checker and spheres agree with MuJoCo's contacts.
"""

from __future__ import annotations

import argparse
import gc
import json
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec
import numpy as np

from benchmarks.comparison import machine
from benchmarks.peers.roboplan_planner import RoboplanPlanner
from benchmarks.planning_contacts import NEAR_M, Agreement, compared
from benchmarks.planning_costs import costs_table, other_costs
from benchmarks.planning_problems import problem_sets
from benchmarks.planning_scenes import ARM, Case, cases, random_case
from engine.messages import Pose
from robots.planning.planner_names import PLANNERS
from robots.planning.request import PathPlan, PlanRequest
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement, FixtureBody, PartBody, SimScene

ROBOPLAN = "RoboPlan"
Found = tuple[Array | None, float]

_PEER = "RRTConnect"
_FINE_M = 0.005
_SLOW = ("RRT", "RRTstar", "InformedRRTstar", "stomp", "PRM", "PRMstar")
_TIME_S = 5.0
# IRB thesis, tables 6 and 7: mean planning time in ms of five tries, without and with an obstacle.
_THESIS_MS = {
    "IRB4600, free": {
        "RRTConnect": 33.4,
        "RRT": 58.8,
        "stomp": 331.0,
        "PRM": 5005.0,
        "PRMstar": 5009.0,
        "RRTstar": 5002.0,
    },
    "IRB4600, one box": {"RRTConnect": 52.6, "RRT": 330.0, "stomp": 553.0},
}
_FAILED = {"IRB4600, one box": ("PRM", "PRMstar", "RRTstar")}


@dataclass(frozen=True, kw_only=True)
class Line:
    """One planner in one case; times are CPU milliseconds of the whole answer, `search_ms` of the search alone (wall).

    `exact` is how many of the paths found the exact checker confirms in steps of 5 mm, `turn_rad` the mean sum of
    all changes of direction of a path, a measure of smoothness.
    """

    case: str
    planner: str
    runs: int
    found: int
    exact: int
    search_ms: float
    p50_ms: float
    p95_ms: float
    length_rad: float
    turn_rad: float
    document_ms: float | None


class Answers:
    """The answers of one planner: CPU time of each, and the paths found."""

    def __init__(self, case: str, planner: str) -> None:
        self._case = case
        self._planner = planner
        self._spent_ms: list[float] = []
        self._searches_ms: list[float] = []
        self._paths: list[Array] = []
        self._exact = 0

    def ask(self, plan: Callable[[], Found], checker: ExactChecker) -> None:
        """Ask once; whether the exact checker confirms the path is looked at outside the timing."""
        gc.disable()
        start = time.process_time_ns()
        path, search_ms = plan()
        self._spent_ms.append((time.process_time_ns() - start) / 1e6)
        gc.enable()
        if path is not None:
            self._searches_ms.append(search_ms)
            self._paths.append(path)
            self._exact += checker.first_collision(path, step_m=_FINE_M) is None

    def line(self) -> Line:
        """Return what was measured."""
        p50, p95 = np.percentile(self._spent_ms, [50, 95]).tolist()
        paths = self._paths
        return Line(
            case=self._case,
            planner=self._planner,
            runs=len(self._spent_ms),
            found=len(paths),
            exact=self._exact,
            search_ms=float(np.median(self._searches_ms)) if paths else float("nan"),
            p50_ms=p50,
            p95_ms=p95,
            length_rad=float(np.median([_length(path) for path in paths])) if paths else float("nan"),
            turn_rad=float(np.mean([_turn(path) for path in paths])) if paths else float("nan"),
            document_ms=_THESIS_MS.get(self._case, {}).get(self._planner),
        )


def measure(case: Case, planner: str, *, runs: int, time_s: float = _TIME_S) -> Line:
    """Run a planner with `runs` seeds; what can be prepared for a scene is prepared before."""
    checker = ExactChecker(case.request.scene, ARM)
    answers = Answers(case.title, planner)
    ask = _asking(planner, case, time_s)
    ask(10_000)
    for seed in range(runs):
        answers.ask(lambda s=seed: ask(s), checker)
    return answers.line()


def random_lines(count: int, planners: Sequence[str]) -> list[Line]:
    """Plan in `count` random scenes, one second each; a scene is prepared outside the timing."""
    return _each_once("random scenes, 1 s", [random_case(seed) for seed in range(count)], planners)


def peers() -> tuple[str, ...]:
    """Return the other libraries that are installed."""
    return (ROBOPLAN,) if find_spec("roboplan") is not None else ()


def _asking(planner: str, case: Case, time_s: float) -> Callable[[int], Found]:
    """Return what plans a case with a seed: the path and the milliseconds of the search alone (wall)."""
    if planner == ROBOPLAN:
        peer = RoboplanPlanner(case.request.scene)
        return lambda seed: (peer.plan(case.request, seed=seed, time_s=time_s), float("nan"))
    service = ScenePlanner()
    service.prepared(case.request.scene, ARM)

    def ask(seed: int) -> Found:
        answer = service.plan(_run(case.request, planner, seed, time_s))
        return (answer.path, answer.stats.search_s * 1e3) if isinstance(answer, PathPlan) else (None, 0.0)

    return ask


def problem_lines(file: Path, planners: Sequence[str], *, most: int = 1000) -> Iterator[list[Line]]:
    """Plan the problems of MotionBenchMaker for a Panda, set by set; `file` is vamp's source distribution."""
    with TemporaryDirectory() as folder:
        for one in problem_sets(file, Path(folder), most=most):
            left_out = f", {one.touching + one.outside} left out" if one.touching + one.outside else ""
            yield _each_once(f"{one.name}{left_out}, 1 s", one.cases, planners)


def _each_once(title: str, drawn: Sequence[Case], planners: Sequence[str]) -> list[Line]:
    """Plan each case once, one second each; a scene is prepared outside the timing."""
    lines: list[Line] = []
    for planner in planners:
        answers = Answers(title, planner)
        # What must be compiled or loaded is, before the first.
        _asking(planner, drawn[0], 60.0)(1)
        for case in drawn:
            ask = _asking(planner, case, 1.0)
            answers.ask(lambda a=ask: a(0), ExactChecker(case.request.scene, ARM))
        lines.append(answers.line())
    return lines


def agreements(configurations: int) -> dict[str, Agreement]:
    """Compare checker, spheres and MuJoCo in three cells."""
    cells = {
        "two Pandas": (_cell("panda", -0.55, other=True), frozenset[str]()),
        "UR10 with Robotiq": (_cell("ur10", -0.6, gripper="robotiq_2f85"), frozenset[str]()),
        # The simulator gives the magnet a square face instead of its round one.
        "IRB4600 with magnet": (_cell("irb4600", -1.2, gripper="magnet"), frozenset({f"{ARM}/magnet_face"})),
    }
    return {
        title: compared(cell, ARM, configurations=configurations, left_out=left_out)
        for title, (cell, left_out) in cells.items()
    }


def table(lines: Sequence[Line]) -> str:
    """Return lines of one case as Markdown."""
    head = (
        "| planner | found | confirmed | search ms | whole answer ms, p50 | p95 | length rad | turns rad | document |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|"
    )
    rows = [
        f"| {line.planner} | {line.found}/{line.runs} | {line.exact} | {line.search_ms:.2f} | {line.p50_ms:.2f}"
        f" | {line.p95_ms:.2f} | {line.length_rad:.2f} | {line.turn_rad:.2f} | {_document(line)} |"
        for line in lines
    ]
    return "\n".join([f"### {lines[0].case}", "", head, *rows])


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=50, help="runs of a planner in a case; a fifth of the slow ones")
    parser.add_argument("--time", type=float, default=_TIME_S, help="seconds for a plan in a case (default 5)")
    parser.add_argument("--scenes", type=int, default=300, help="random scenes, or problems of a set (default 300)")
    parser.add_argument("--configurations", type=int, default=10_000, help="compared with MuJoCo, in each cell")
    parser.add_argument("--costs", type=int, default=50, help="runs of what is not a search (default 50)")
    parser.add_argument("--problems", type=Path, metavar="FILE", help="vamp's source distribution, for its problems")
    parser.add_argument("--case", default="", help="only experiments with this in their title")
    parser.add_argument("--planner", action="append", help="only this planner (may be repeated)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures to FILE")
    options = parser.parse_args()
    print(f"CPU time; the search is wall time; {machine()}.\n")
    done: list[Line] = []
    for case in (case for case in cases() if options.case in case.title):
        lines = [
            measure(
                case,
                planner,
                runs=max(1, options.runs // 5) if planner in _SLOW else options.runs,
                time_s=options.time,
            )
            for planner in options.planner or (*PLANNERS, *peers())
        ]
        print(table(lines), end="\n\n", flush=True)
        done += lines
    beside = options.planner or ("fast", _PEER, *peers())
    if options.scenes and not options.problems:
        lines = random_lines(options.scenes, beside)
        print(table(lines), end="\n\n", flush=True)
        done += lines
    if options.problems:
        for lines in problem_lines(options.problems, beside, most=options.scenes):
            print(table(lines), end="\n\n", flush=True)
            done += lines
    costs = other_costs(options.costs) if options.costs else {}
    if costs:
        print(costs_table(costs), end="\n\n")
    found = agreements(options.configurations) if options.configurations else {}
    for title, agreement in found.items():
        print(f"{title}: {_words(agreement)}")
    if options.json:
        figures = {
            "lines": [asdict(line) for line in done],
            "costs_ms": costs,
            "contacts": {title: asdict(agreement) for title, agreement in found.items()},
        }
        options.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")


def _run(request: PlanRequest, planner: str, seed: int, time_s: float) -> PlanRequest:
    return msgspec.structs.replace(request, planner=planner, seed=seed, time_s=time_s)


def _length(path: Array) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def _turn(path: Array) -> float:
    directions = np.diff(path, axis=0)
    directions /= np.maximum(np.linalg.norm(directions, axis=1, keepdims=True), 1e-12)
    return float(np.arccos(np.clip((directions[:-1] * directions[1:]).sum(axis=1), -1.0, 1.0)).sum())


def _document(line: Line) -> str:
    if line.planner in _FAILED.get(line.case, ()):
        return "failed"
    return "" if line.document_ms is None else f"{line.document_ms:.0f}"


def _words(found: Agreement) -> str:
    return (
        f"{found.configurations} configurations, {found.touching} touch; beyond {NEAR_M * 1e3:g} mm MuJoCo alone names"
        f" {len(found.only_mujoco)} pairs, the checker alone {len(found.only_ours)}; {found.close} differ within that;"
        f" the spheres take {found.spheres_free} that touch for free, {found.spheres_blocked} free ones for touching"
    )


def _cell(model: str, x: float, *, gripper: str | None = "own", other: bool = False) -> SimScene:
    def arm(name: str, at: float) -> ArmPlacement:
        return ArmPlacement(name=name, model=model, base=Pose(xyz=(at, 0.0, 0.0)), gripper=gripper)

    return SimScene(
        arms=(arm(ARM, x), arm("other", -x)) if other else (arm(ARM, x),),
        fixtures=(
            FixtureBody(name="tray", shape="tray", size_m=(0.3, 0.2, 0.02), pose=Pose(xyz=(0.0, 0.3, 0.0))),
            FixtureBody(name="post", shape="cylinder", size_m=(0.1, 0.8), pose=Pose(xyz=(0.1, 0.2, 0.4))),
        ),
        parts=(
            PartBody(name="box", shape="box", size_m=(0.1, 0.1, 0.3), mass_kg=1.0, pose=Pose(xyz=(0.0, -0.3, 0.15))),
            PartBody(name="ball", shape="sphere", size_m=(0.2,), mass_kg=1.0, pose=Pose(xyz=(0.0, 0.0, 0.6))),
        ),
    )


if __name__ == "__main__":
    main()
