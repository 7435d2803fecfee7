"""What sweeps cost, and whether their intervals hold.

    python -m benchmarks.sweep [--runs 20] [--behavior FILE] [--truth 500]

The first table has runs per CPU-hour of a behavior in warm worker processes and in cold ones (a process a run), the
overhead of a run that does nothing, and the memory of a worker over its runs; event hashes of both must be equal. The
second table executes sweeps of planted success rates, looks at the interval after every run, and counts the sweeps
that miss the rate at any time, beside the exact interval of Clopper and Pearson looked at in the same way; and the
runs that a gate needs.
"""

from __future__ import annotations

import argparse
import random
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import msgspec

from engine.document.sweep import parse_sweep
from engine.sweep import (
    SweepEnd,
    SweepProgress,
    SweepResults,
    SweepSubject,
    WorkerOptions,
    configurations,
    execute_sweep,
)
from engine.sweep.statistics import Interval, exact_interval, rate_interval

BEHAVIOR = Path(__file__).resolve().parents[1] / "behaviors" / "reconcycle" / "two_arm_transfer.yaml"
RATES = (0.5, 0.9, 0.97, 0.99)
LOOKS = 300
REQUIRED = 0.98
MOST = 2000
TRIVIAL = """\
flexcell: 1
name: trivial
outcomes: [done]
success: [done]
root: {machine: {initial: only, states: {only: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: done}}}}}
"""


def swept(behavior: Path, runs: int, options: WorkerOptions, folder: Path) -> tuple[SweepEnd, list[int]]:
    """Execute a sweep over seeds alone; returns its end and the memory of workers after each run, in bytes."""
    text = msgspec.json.encode({"flexcell": 1, "behavior": str(behavior), "runs": runs})
    subject = SweepSubject.load(parse_sweep(text, file=folder / "sweep.yaml"))
    planned = configurations(subject.sweep)
    with tempfile.TemporaryDirectory(dir=folder) as name, SweepResults.open(Path(name) / "r.db") as saved:
        end = execute_sweep(subject, planned, saved, options, show=_progress)
    return end, [result.memory_bytes for result in end.results]


def _progress(progress: SweepProgress) -> None:
    sys.stderr.write(f"\r{progress.count.done} runs ")
    sys.stderr.flush()


def costs(behavior: Path, runs: int, folder: Path) -> None:
    """Print the first table."""
    cpu_started_s = _cpu_of_children_s()
    warm, memory = swept(behavior, runs, WorkerOptions(workers=2), folder)
    warm_s = _cpu_of_children_s() - cpu_started_s
    cold_runs = max(runs // 5, 2)
    cpu_started_s = _cpu_of_children_s()
    cold, _ = swept(behavior, cold_runs, WorkerOptions(workers=2, runs_of_process=1), folder)
    cold_s = _cpu_of_children_s() - cpu_started_s
    trivial = folder / "trivial.yaml"
    trivial.write_text(TRIVIAL, encoding="utf-8")
    started_s = time.perf_counter()
    many, _ = swept(trivial, 1000, WorkerOptions(workers=1, runs_of_process=2000), folder)
    trivial_s = time.perf_counter() - started_s
    equal = [one.events_sha256 for one in warm.results[:cold_runs]] == [one.events_sha256 for one in cold.results]
    print(f"\n{behavior.name}, {runs} runs warm, {cold_runs} cold; events {'equal' if equal else 'DIFFERENT'}\n")
    print("| | CPU-s a run | runs per CPU-hour |\n|---|--:|--:|")
    for name, cpu_s, count in (("warm", warm_s, runs), ("cold", cold_s, cold_runs)):
        print(f"| {name} | {cpu_s / count:.2f} | {3600 * count / cpu_s:.0f} |")
    print(f"\nmemory of a worker: {memory[0] / 1e6:.0f} MB after its first run, {max(memory) / 1e6:.0f} MB at most")
    print(f"a run that does nothing: {1e3 * trivial_s / len(many.results):.1f} ms, of 1,000 in one worker\n")


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


def _cpu_of_children_s() -> float:

    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--behavior", type=Path, default=BEHAVIOR)
    parser.add_argument("--truth", type=int, default=500)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        costs(options.behavior.resolve(), options.runs, Path(folder))
    truth(options.truth)


if __name__ == "__main__":
    main()
