"""Kills a run at its events and around its commits, resumes it, and compares: prints a table.

`python -P benchmarks/crash_recovery.py` kills at every point of four behaviors, the two-arm transfer and the
test cylinder in physics among them (about half an hour); `--subject press --every 5` at every fifth of one.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import msgspec

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.crash_point import CrashPoint, Moment  # noqa: E402
from benchmarks.crash_subjects import SUBJECTS, Subject  # noqa: E402
from benchmarks.crash_trial import End, Trial, crash, whole  # noqa: E402

POINTS: tuple[Moment, ...] = ("event", "before commit", "after commit")


def points(end: End, every: int) -> Iterator[CrashPoint]:
    """Go through every `every`-th crash point; after the last commit a run is over and cannot be resumed."""
    for moment in POINTS:
        last = end.counts[moment] - (moment == "after commit")
        for number in range(1, last + 1, every):
            yield CrashPoint(moment=moment, number=number)


def examine(subject: Subject, folder: Path, *, every: int, again: Sequence[int]) -> tuple[End, list[Trial]]:
    """Make all trials of a subject."""
    more = [CrashPoint(moment="event", number=number) for number in again]
    due, _ = whole(subject, folder / "whole")
    trials: list[Trial] = []
    for number, point in enumerate(points(due, every)):
        place = folder / str(number)
        trials.append(crash(subject, place, point, due, again=more))
        shutil.rmtree(place)
    return due, trials


def main() -> int:
    """Print the table; exit code 1 when a run did not end as it should."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--subject", action="append", choices=list(SUBJECTS), help="only this one; may be repeated")
    parser.add_argument("--every", type=int, default=1, help="only every so-manieth point")
    parser.add_argument(
        "--again", type=int, nargs="*", default=[], help="the n-th that resumes dies at this event of it"
    )
    parser.add_argument("--json", type=Path, help="write every trial here")
    options = parser.parse_args()
    written: dict[str, list[Trial]] = {}
    print(
        "| behavior | crash points | engines | ended as without crash | effects twice | wall s |\n"
        "|---|---|---|---|---|---|"
    )
    for name in options.subject or SUBJECTS:
        started_s = time.perf_counter()
        # Nobody pulls the plug: what is killed here loses nothing that the memory of the machine holds.
        with tempfile.TemporaryDirectory(dir="/dev/shm" if Path("/dev/shm").is_dir() else None) as folder:
            due, trials = examine(SUBJECTS[name], Path(folder), every=options.every, again=options.again)
        good = sum(not trial.problems for trial in trials)
        twice = sum(len(trial.effects) - len(set(trial.effects)) for trial in trials)
        engines = sum(trial.engines for trial in trials)
        wall_s = time.perf_counter() - started_s
        print(f"| {name} | {len(trials)} | {engines} | {good} ({due.outcome}) | {twice} | {wall_s:.0f} |", flush=True)
        for trial in trials:
            for problem in trial.problems:
                print(f"{name}, killed at {trial.moment} {trial.number}: {problem}", file=sys.stderr)
        written[name] = trials
    if options.json:
        options.json.write_bytes(msgspec.json.encode(written))
    return 0 if all(not trial.problems for trials in written.values() for trial in trials) else 1


if __name__ == "__main__":
    sys.exit(main())
