"""Measures inverse kinematics on random reachable poses: `python -P benchmarks/ik.py [--poses N] [--json FILE]`.

Prints a table for each arm: this project, EAIK by itself, pin-pink, a plain damped least squares and the
solver that this project had before; then what loading and compiling cost. About two minutes.
"""

from __future__ import annotations

import argparse
import gc
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from benchmarks.comparison import machine
from benchmarks.ik_arms import Request, arms, requests, solves
from benchmarks.peers.ik_solvers import Solver, damped_least_squares, eaik, flexcell, pink
from benchmarks.peers.python_descents import PythonDescents
from robots.model.mechanics.kinematics import ArmKinematics

_SLOW_SHARE = 10
_LOADING = """
import time
import numba
start = time.process_time()
import robots.model.inverse_kinematics.kernels
print(time.process_time() - start)
"""


@dataclass(frozen=True, kw_only=True)
class Line:
    """One solver on one arm: poses asked, share solved, thread CPU time of a request in microseconds."""

    arm: str
    solver: str
    poses: int
    solved: float
    p50_us: float
    p95_us: float
    max_us: float


def measure(arm: str, solver: str, kinematics: ArmKinematics, solve: Solver, asked: Sequence[Request]) -> Line:
    """Ask one solver for all poses; every answer is checked by forward kinematics, outside the timing."""
    solve(asked[0].target, asked[0].seed)
    spent_us: list[float] = []
    solved = 0
    gc.disable()
    for request in asked:
        start = time.thread_time_ns()
        joints = solve(request.target, request.seed)
        spent_us.append((time.thread_time_ns() - start) / 1e3)
        solved += joints is not None and solves(kinematics, request.target, joints)
    gc.enable()
    p50, p95, most = np.percentile(spent_us, [50, 95, 100]).tolist()
    return Line(
        arm=arm, solver=solver, poses=len(asked), solved=solved / len(asked), p50_us=p50, p95_us=p95, max_us=most
    )


def lines_of(arm: str, kinematics: ArmKinematics, poses: int) -> list[Line]:
    """Measure all solvers on one arm; the slow ones are given every tenth pose."""
    asked = requests(kinematics, poses)
    before = PythonDescents(kinematics)
    fast: dict[str, Solver | None] = {"flexcell, nearest": flexcell(kinematics), "EAIK, any": eaik(kinematics)}
    slow: dict[str, Solver | None] = {
        "flexcell before, nearest": lambda target, seed: before.nearest(target, seed=seed),
        "damped least squares, any": damped_least_squares(kinematics),
        "pin-pink, any": pink(kinematics),
    }
    found = [measure(arm, name, kinematics, solve, asked) for name, solve in fast.items() if solve is not None]
    few = asked[:: min(_SLOW_SHARE, len(asked))]
    return found + [measure(arm, name, kinematics, solve, few) for name, solve in slow.items() if solve is not None]


def table(lines: Sequence[Line]) -> str:
    """Return the lines of one arm as Markdown; ratios are of the medians, to the first line."""
    head = "| solver | poses | solved % | p50 µs | p95 µs | max µs | × ours |\n|---|---:|---:|---:|---:|---:|---:|"
    rows = [
        f"| {line.solver} | {line.poses} | {100 * line.solved:.1f} | {line.p50_us:,.0f} | {line.p95_us:,.0f}"
        f" | {line.max_us:,.0f} | {_ratio(line.p50_us / lines[0].p50_us)} |"
        for line in lines
    ]
    return "\n".join([f"### {lines[0].arm}", "", head, *rows])


def _ratio(value: float) -> str:
    return f"{value:.2g}" if value < 10.0 else f"{value:.0f}"


def loading_s(cache: Path) -> float:
    """Return the CPU time of loading the compiled loops in a fresh process, numba's own import not counted."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache), "PYTHONPATH": str(Path(__file__).parents[1])}
    command = [sys.executable, "-P", "-c", _LOADING]
    return float(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--poses", type=int, default=1000, help="random reachable poses for each arm (default 1000)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures to FILE")
    options = parser.parse_args()
    print(f"Thread CPU time of one request; {machine()}.\n")
    done: list[Line] = []
    with tempfile.TemporaryDirectory() as folder:
        for title, kinematics in arms(Path(folder)).items():
            lines = lines_of(title, kinematics, options.poses)
            print(table(lines), end="\n\n", flush=True)
            done += lines
        cache = Path(folder) / "cache"
        cold_s, warm_s = loading_s(cache), loading_s(cache)
    print(f"Loading the compiled loops: {cold_s:.1f} s CPU where they must be compiled, {warm_s:.2f} s from the cache.")
    if options.json:
        figures = {"lines": [asdict(line) for line in done], "compile_s": cold_s, "load_s": warm_s}
        options.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
