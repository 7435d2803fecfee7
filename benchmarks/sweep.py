"""What sweeps cost, and whether their intervals hold.

    python -m benchmarks.sweep [--runs 20] [--behavior FILE] [--truth 500]
    python -m benchmarks.sweep --soak [--runs 1000]

The first table has runs per CPU-hour of a behavior in warm worker processes, in cold ones (a process a run), and on a
Dask cluster of this machine with two workers; event hashes of all must be equal. The second one has the time of a run
that does nothing, and the memory of its process and of Dask's own over 1,000 of them. The third one executes sweeps of
planted success rates, looks at the interval after every run, and counts the sweeps that miss the rate at any time,
beside the exact interval of Clopper and Pearson looked at in the same way; and the runs that a gate needs.

`--soak` kills and stops processes of a sweep and fills its disk; see `benchmarks.sweep_soak`.
"""

from __future__ import annotations

import argparse
import os
import random
import resource
import sys
import tempfile
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
from distributed import LocalCluster

from benchmarks.sweep_soak import soak
from engine.document.sweep import parse_sweep
from engine.sweep import (
    ClusterOptions,
    SweepEnd,
    SweepProgress,
    SweepResults,
    SweepSubject,
    WorkerOptions,
    configurations,
    execute_sweep,
)
from engine.sweep.execution.trial_execution import ExecutionOptions
from engine.sweep.statistics import Interval, exact_interval, rate_interval

BEHAVIOR = Path(__file__).resolve().parents[1] / "behaviors" / "reconcycle" / "two_arm_transfer.yaml"
RATES = (0.5, 0.9, 0.97, 0.99)
LOOKS = 300
REQUIRED = 0.98
MOST = 2000
PAGE = os.sysconf("SC_PAGESIZE")
TRIVIAL = """\
flexcell: 1
name: trivial
outcomes: [done]
success: [done]
root: {machine: {initial: only, states: {only: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: done}}}}}
"""


def swept(behavior: Path, runs: int, options: ExecutionOptions, folder: Path) -> SweepEnd:
    """Execute a sweep over seeds alone, without results of before."""
    text = msgspec.json.encode({"flexcell": 1, "behavior": str(behavior), "runs": runs})
    subject = SweepSubject.load(parse_sweep(text, file=folder / "sweep.yaml"))
    planned = configurations(subject.sweep)
    with tempfile.TemporaryDirectory(dir=folder) as name, SweepResults.open(Path(name) / "r.db") as saved:
        return execute_sweep(subject, planned, saved, options, show=_progress)


def _progress(progress: SweepProgress) -> None:
    sys.stderr.write(f"\r{progress.count.done} runs ")
    sys.stderr.flush()


@contextmanager
def cluster(workers: int) -> Generator[tuple[ClusterOptions, Callable[[], int]]]:
    """Start a Dask cluster of processes; yields how it is reached, and how much memory its largest worker has."""
    # Dask has no types.
    start: Any = LocalCluster
    started: Any = start(n_workers=workers, threads_per_worker=1, dashboard_address=":0", memory_limit=0)
    with started:
        yield ClusterOptions(scheduler=str(started.scheduler_address)), lambda: max(_resident_bytes(started))


def _resident_bytes(started: Any) -> list[int]:
    return [
        int(Path(f"/proc/{worker.pid}/statm").read_text("ascii").split()[1]) * PAGE
        for worker in started.workers.values()
    ]


def costs(behavior: Path, runs: int, folder: Path) -> None:
    """Print the first table."""
    cold_runs = max(runs // 5, 2)
    ends: dict[str, tuple[SweepEnd, float]] = {}
    for name, count, options in (
        ("warm", runs, WorkerOptions(workers=2)),
        ("cold", cold_runs, WorkerOptions(workers=2, runs_of_process=1)),
    ):
        started_s = _cpu_s()
        ends[name] = swept(behavior, count, options, folder), _cpu_s() - started_s
    started_s = _cpu_s()
    with cluster(2) as (options, _):
        end = swept(behavior, runs, options, folder)
    ends["Dask"] = end, _cpu_s() - started_s
    hashes = {tuple(each.events_sha256 for each in end.results[:cold_runs]) for end, _ in ends.values()}
    print(f"\n{behavior.name}, {runs} runs, {cold_runs} cold; events {'equal' if len(hashes) == 1 else 'DIFFERENT'}\n")
    print("| | CPU-s a run | runs per CPU-hour |\n|---|--:|--:|")
    for name, (end, cpu_s) in ends.items():
        print(f"| {name} | {cpu_s / end.executed:.2f} | {3600 * end.executed / cpu_s:.0f} |")


def overhead(folder: Path) -> None:
    """Print the second table."""
    trivial = folder / "trivial.yaml"
    trivial.write_text(TRIVIAL, encoding="utf-8")
    print("\n| 1,000 runs that do nothing | ms a run | MB of its process, first and most | MB of Dask's worker |")
    print("|---|--:|--:|--:|")
    started_s = time.perf_counter()
    end = swept(trivial, 1000, WorkerOptions(workers=1, runs_of_process=2000), folder)
    print(_overhead_row("warm, one process", end, time.perf_counter() - started_s, ""))
    with cluster(1) as (options, memory_bytes):
        swept(trivial, 1, options, folder)
        first_bytes = memory_bytes()
        started_s = time.perf_counter()
        end = swept(trivial, 1000, replace(options, runs_of_process=2000), folder)
        took_s = time.perf_counter() - started_s
        most = f"{first_bytes / 1e6:.0f}, {memory_bytes() / 1e6:.0f}"
    print(_overhead_row("Dask, one worker", end, took_s, most), end="\n\n")


def _overhead_row(name: str, end: SweepEnd, took_s: float, dask: str) -> str:
    memory = [result.memory_bytes / 1e6 for result in end.results]
    return f"| {name} | {1e3 * took_s / end.executed:.1f} | {memory[0]:.0f}, {max(memory):.0f} | {dask} |"


def truth(sweeps: int) -> None:
    """Print the second table."""
    print(f"| rate | wrong in {sweeps} sweeps of {LOOKS} looks | exact interval | runs of a gate at {REQUIRED:.0%} |")
    print("|--:|--:|--:|---|")
    for rate in RATES:
        wrong = sum(_excludes(rate, f"{rate} {sweep}", rate_interval) for sweep in range(sweeps))
        naive = sum(_excludes(rate, f"{rate} {sweep}", exact_interval) for sweep in range(sweeps))
        lengths = sorted(_gate(rate, f"gate {rate} {sweep}") for sweep in range(sweeps // 5))
        middle = lengths[len(lengths) // 2]
        shown = f"{middle} (median)" if middle < MOST else f"undecided after {MOST}"
        print(f"| {rate} | {wrong / sweeps:.1%} | {naive / sweeps:.1%} | {shown} |")


def _excludes(rate: float, seed: str, interval: Callable[[int, int], Interval]) -> bool:
    source, successes = random.Random(seed), 0
    for runs in range(1, LOOKS + 1):
        successes += source.random() < rate
        found = interval(successes, runs)
        if not found.low <= rate <= found.high:
            return True
    return False


def _gate(rate: float, seed: str) -> int:
    source, successes = random.Random(seed), 0
    for runs in range(1, MOST + 1):
        successes += source.random() < rate
        found = rate_interval(successes, runs)
        if found.low >= REQUIRED or found.high < REQUIRED:
            return runs
    return MOST


def _cpu_s() -> float:
    """Of this process, where Dask's scheduler is, and of those that have ended."""
    used = [resource.getrusage(of) for of in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int)
    parser.add_argument("--behavior", type=Path, default=BEHAVIOR)
    parser.add_argument("--truth", type=int, default=500)
    parser.add_argument("--soak", action="store_true")
    options = parser.parse_args()
    if options.soak:
        sys.exit(not soak(options.runs or 1000, seed=1))
    with tempfile.TemporaryDirectory() as folder:
        costs(options.behavior.resolve(), options.runs or 20, Path(folder))
        overhead(Path(folder))
    truth(options.truth)


if __name__ == "__main__":
    main()
