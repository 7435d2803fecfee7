"""A sweep whose processes are killed and stopped and whose disk is full, beside one that nothing disturbs.

Each part of it is a process that executes what is left, as `flexcell sweep` does. A run of which a worker was killed
or stopped has crashed or hung, until the last part executes those again; no other result may be lost, executed twice,
or differ from that of the undisturbed sweep.
"""

from __future__ import annotations

import os
import random
import signal
import sqlite3
import subprocess
import sys
import tempfile
from collections import Counter
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from engine.document.sweep import load_sweep
from engine.sweep import (
    SweepResults,
    SweepSubject,
    TrialResult,
    WorkerOptions,
    configurations,
    execute_sweep,
    saved_sweep,
)
from engine.sweep.results import without_costs

BEHAVIOR = """\
flexcell: 1
name: trivial
parameters:
  wait: {type: number, default: 1.0, description: Seconds}
outcomes: [done]
success: [done]
root:
  machine:
    initial: only
    states: {only: {state: flow.Wait, with: {duration_s: "${wait}"}, transitions: {done: done}}}
"""
DRIVER = """
import resource, sys
from pathlib import Path
from engine.document.sweep import load_sweep
from engine.errors import FlexcellError
from engine.sweep import SweepResults, SweepSubject, WorkerOptions, configurations, execute_sweep

file, results, timeout_s, limit, again = sys.argv[1:]
sweep = load_sweep(file)
with SweepResults.open(Path(results)) as saved:
    if int(limit):
        resource.setrlimit(resource.RLIMIT_FSIZE, (int(limit), resource.RLIM_INFINITY))
    try:
        execute_sweep(
            SweepSubject.load(sweep), configurations(sweep), saved,
            WorkerOptions(workers=2, timeout_s=float(timeout_s)), again=bool(int(again)),
            show=lambda progress: print(progress.count.done, flush=True),
        )
    except FlexcellError as error:
        sys.exit(str(error))
"""
TIMEOUT_S = 5.0
ROOM_BYTES = 60_000
"""What a file may still grow by when its disk is nearly full."""


@dataclass
class Disturbed:
    """What was done to a sweep, and how many runs its parts have executed."""

    done: Counter[str] = field(default_factory=Counter[str])
    executed: int = 0
    twice: int = 0
    """Runs executed in a part beyond the results that it added; those that are executed again on request count too."""
    parts: int = 0


def soak(runs: int, seed: int) -> bool:
    """Execute both sweeps and print what came out; returns whether nothing was lost, repeated or different."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "trivial.yaml").write_text(BEHAVIOR, encoding="utf-8")
        file = folder / "sweep.yaml"
        factors = {"parameters.wait": {"uniform": [0.0, 2.0]}}
        document = {"flexcell": 1, "behavior": "trivial.yaml", "runs": runs, "factors": factors}
        file.write_bytes(msgspec.json.encode(document))
        calm = _calm(file, folder / "calm.db")
        results = folder / "disturbed.db"
        disturbed = Disturbed()
        _disturb(file, results, runs, random.Random(seed), disturbed)
        first = _table(file, results)
        broken = sum(each.broken for each in first)
        _part(file, results, disturbed, again=True)
        second = _table(file, results)
    lost, different = runs - len(second), sum(one != other for one, other in zip(calm, second, strict=False))
    twice = disturbed.twice - broken
    done = ", ".join(f"{count} x {what}" for what, count in disturbed.done.items())
    print(f"\n{runs} runs in {disturbed.parts} parts; {done}\n")
    print("| lost | executed although saved | different | crashed or hung, then executed again |\n|--:|--:|--:|--:|")
    print(f"| {lost} | {twice} | {different} | {broken} |\n")
    return not (lost or twice or different) and broken > 0


def _calm(file: Path, results: Path) -> list[TrialResult]:
    sweep = load_sweep(file)
    with SweepResults.open(results) as saved:
        end = execute_sweep(SweepSubject.load(sweep), configurations(sweep), saved, WorkerOptions(workers=2))
    return [without_costs(each) for each in end.results]


def _table(file: Path, results: Path) -> list[TrialResult]:
    sweep = load_sweep(file)
    with SweepResults.open(results) as saved:
        return [
            without_costs(each) for each in saved_sweep(SweepSubject.load(sweep), configurations(sweep), saved).results
        ]


def _disturb(file: Path, results: Path, runs: int, chance: random.Random, disturbed: Disturbed) -> None:
    """Execute the sweep in parts until each configuration has a result: each part but the last ends by force."""
    for number in range(1, 6):
        full = number in (2, 4)
        due = min(number * runs // 6, runs - 1)
        _part(file, results, disturbed, kill_at=None if full else due, full=full, chance=chance)
    _part(file, results, disturbed, chance=chance)


def _part(
    file: Path,
    results: Path,
    disturbed: Disturbed,
    *,
    kill_at: int | None = None,
    full: bool = False,
    chance: random.Random | None = None,
    again: bool = False,
) -> None:
    limit = max((each.stat().st_size for each in _files(results)), default=0) + ROOM_BYTES if full else 0
    arguments = [str(file), str(results), str(TIMEOUT_S), str(limit), str(int(again))]
    driver = subprocess.Popen(
        [sys.executable, "-c", DRIVER, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    disturbed.parts += 1
    before, saved = disturbed.executed, _rows(results)
    assert driver.stdout is not None
    assert driver.stderr is not None
    for line in driver.stdout:
        disturbed.executed += 1
        sys.stderr.write(f"\r{line.strip()} results ")
        if kill_at is not None and int(line) >= kill_at:
            driver.kill()
            kill_at = None
            disturbed.done["kill -9 of the driver"] += 1
        elif chance is not None and (disturbed.executed - before) in (20, 90):
            _hit_a_worker(driver.pid, chance, disturbed)
    driver.wait()
    output = driver.stderr.read()
    driver.stdout.close()
    driver.stderr.close()
    # A driver that is killed may have saved one more than it could print.
    disturbed.twice += max(disturbed.executed - before - (_rows(results) - saved), 0)
    if full:
        assert "results cannot be written" in output, output
        disturbed.done["full disk"] += 1


def _hit_a_worker(driver: int, chance: random.Random, disturbed: Disturbed) -> None:
    children = Path(f"/proc/{driver}/task/{driver}/children").read_text("ascii").split()
    # One that is just being started has no program of its own yet: stopped then, it would stop its parent for ever.
    workers = [
        int(each) for each in children if b"engine.sweep.execution.worker" in Path(f"/proc/{each}/cmdline").read_bytes()
    ]
    if workers:
        how = chance.choice((signal.SIGKILL, signal.SIGSTOP))
        os.kill(chance.choice(workers), how)
        disturbed.done["kill -9 of a worker" if how is signal.SIGKILL else "worker that hangs"] += 1


def _rows(results: Path) -> int:
    if not results.exists():
        return 0
    with closing(sqlite3.connect(results)) as connection:
        return int(connection.execute("SELECT count(*) FROM results").fetchone()[0])


def _files(results: Path) -> list[Path]:
    return [each for each in (results, results.with_name(f"{results.name}-wal")) if each.exists()]
