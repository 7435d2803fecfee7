"""What holds when arms differ from their models: `python -P -m benchmarks.doubt [--seeds 50] [--only motions]`.

The first table has figures of motions under `realism: ideal`, `typical` and `poor` side by side, see
`benchmarks.doubt_motions`. The others execute applications as sweeps over seeds: parts lie within their jitter, and the
errors of the arms are drawn anew in each run. Each run and figure is saved as soon as it has ended, in the folder
`--results`; the same command goes on with what is left, and `--report` prints what there is. `--for 600` begins
nothing after ten minutes. Another version of the code needs another folder.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import msgspec

from benchmarks.doubt_motions import FIGURES, measure_figure
from engine.document import RealismName
from engine.document.duration import seconds
from engine.document.sweep import Sweep, parse_sweep
from engine.sweep import (
    SweepEnd,
    SweepProgress,
    SweepResults,
    SweepSubject,
    TrialResult,
    WorkerOptions,
    configurations,
    execute_sweep,
    saved_sweep,
)

BEHAVIORS = Path(__file__).resolve().parents[1] / "behaviors"
APPLICATIONS = {
    "transfer": "reconcycle/two_arm_transfer.yaml",
    "A2 pick and place": "pick_and_place/pick_and_place.yaml",
    "A3 plate": "plate_transfer/plate_transfer.yaml",
    "A4 test cylinder": "test_cylinder/test_cylinder.yaml",
}
REALISMS: tuple[RealismName, ...] = ("ideal", "typical", "poor")
_MEASURES = ("cell.contact_force_max_n", "run.duration_s")


class Figure(msgspec.Struct, frozen=True, kw_only=True):
    """A figure of motions under a realism; the text is what the table shows."""

    name: str
    realism: RealismName
    text: str


def application_sweep(behavior: str, realism: RealismName, seeds: int, *, time_s: float | None = None) -> Sweep:
    """Return the sweep of an application over seeds."""
    document: dict[str, object] = {
        "flexcell": 1,
        "behavior": str(BEHAVIORS / behavior),
        "factors": {"cell.world.realism": {"values": [realism]}},
        "runs": seeds,
        # A busy machine must not end runs: the limit on the clock of the run ends those that hang.
        "timeout": "2 h",
    }
    if time_s is not None:
        document["time"] = f"{max(1, round(time_s))} s"
    return parse_sweep(msgspec.json.encode(document), file=BEHAVIORS / "doubt.yaml")


def run_application(sweep: Sweep, saved: SweepResults, *, workers: int, execute: bool) -> SweepEnd:
    """Return the results of a sweep, after its missing runs have been executed."""
    subject = SweepSubject.load(sweep)
    planned = configurations(sweep)
    if not execute:
        return saved_sweep(subject, planned, saved)
    options = WorkerOptions(workers=workers, timeout_s=seconds(sweep.document.timeout))
    return execute_sweep(subject, planned, saved, options, again=True, show=_progress)


def application_row(name: str, realism: RealismName, end: SweepEnd) -> str:
    """Return the line of an application: how often it succeeded, with the interval, and what it pressed with.

    The interval is that of `flexcell sweep`, which counts a process that was ended as a failure.
    """
    results = judged(end)
    if not results:
        return f"| {name} | {realism} | – | | | |"
    good = sum(each.success for each in results)
    rate = end.count.interval
    within = "" if rate is None else f"{rate.low:.1%} to {rate.high:.1%}"
    cells = [_most(end, measure) for measure in _MEASURES]
    return f"| {name} | {realism} | {good} of {len(results)} | {within} | {' | '.join(cells)} |"


def judged(end: SweepEnd) -> list[TrialResult]:
    """Return the results that tell something of the application: not those whose process was ended or crashed."""
    return [each for each in end.results if each.status not in ("crashed", "hung")]


def failure_rows(name: str, realism: RealismName, end: SweepEnd) -> list[str]:
    """Return a line for each failure: the number of its configuration, its status and its chain of causes."""
    return [
        f"| {name} | {realism} | {each.configuration.number} | {each.outcome or each.status} | {each.cause} |"
        for each in end.results
        if not each.success
    ]


def saved_figures(file: Path) -> dict[tuple[str, RealismName], Figure]:
    """Return the figures of a file of JSON lines; the last line of equal ones counts."""
    if not file.exists():
        return {}
    lines = [line for line in file.read_bytes().splitlines(keepends=True) if line.endswith(b"\n")]
    figures = [msgspec.json.decode(line, type=Figure) for line in lines]
    return {(figure.name, figure.realism): figure for figure in figures}


def measure_figures(file: Path, realisms: Sequence[RealismName], until_s: float) -> None:
    """Measure the figures that the file lacks, one line each, as long as there is time."""
    for name in FIGURES:
        for realism in realisms:
            if (name, realism) in saved_figures(file) or time.monotonic() > until_s:
                continue
            print(f"{name}, {realism}", file=sys.stderr, flush=True)
            figure = Figure(name=name, realism=realism, text=measure_figure(name, realism))
            with file.open("ab") as lines:
                lines.write(msgspec.json.encode(figure) + b"\n")


def print_figures(file: Path, realisms: Sequence[RealismName]) -> None:
    """Print the figures, one column for each realism."""
    saved = saved_figures(file)
    print("| figure | " + " | ".join(realisms) + " |\n|---|" + "---:|" * len(realisms))
    for name in FIGURES:
        cells = [saved[name, realism].text if (name, realism) in saved else "–" for realism in realisms]
        print(f"| {name} | " + " | ".join(cells) + " |")


def _most(end: SweepEnd, measure: str) -> str:
    values = [each.measures[measure] for each in end.results if measure in each.measures]
    return f"{max(values):.3g}" if values else ""


def _progress(progress: SweepProgress) -> None:
    sys.stderr.write(f"\r{progress.count.done} runs ")
    sys.stderr.flush()


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, execute and print the tables; exit code 1 where fewer than 98 % of the runs of one succeed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50, help="runs of each application (default 50)")
    parser.add_argument("--realism", nargs="+", choices=REALISMS, default=REALISMS, help="of the motions")
    parser.add_argument("--runs-under", nargs="*", choices=REALISMS, default=("typical",), help="of the applications")
    parser.add_argument("--application", nargs="*", choices=tuple(APPLICATIONS), default=tuple(APPLICATIONS))
    parser.add_argument("--results", type=Path, default=Path(".flexcell/doubt"), help="folder of the results")
    parser.add_argument("--workers", type=int, default=1, help="processes that execute runs (default 1)")
    parser.add_argument("--for", type=float, default=float("inf"), dest="seconds", help="seconds after which it ends")
    parser.add_argument("--only", choices=("motions", "applications"))
    parser.add_argument("--report", action="store_true", help="execute nothing")
    options = parser.parse_args(arguments)
    folder: Path = options.results
    folder.mkdir(parents=True, exist_ok=True)
    until_s = time.monotonic() + options.seconds
    if options.only != "applications":
        if not options.report:
            measure_figures(folder / "figures.jsonl", options.realism, until_s)
        print_figures(folder / "figures.jsonl", options.realism)
    return 0 if options.only == "motions" else print_applications(options, folder, until_s)


def print_applications(options: argparse.Namespace, folder: Path, until_s: float) -> int:
    """Execute the applications and print their tables; return 1 where fewer than 98 % of the runs of one succeed."""
    rows: list[str] = []
    failures: list[str] = []
    enough = True
    with SweepResults.open(folder / "runs.db") as saved:
        for name in options.application:
            for realism in options.runs_under:
                left_s = until_s - time.monotonic()
                sweep = application_sweep(
                    APPLICATIONS[name], realism, options.seeds, time_s=left_s if left_s < float("inf") else None
                )
                execute = not options.report and left_s > 0.0
                end = run_application(sweep, saved, workers=options.workers, execute=execute)
                rows.append(application_row(name, realism, end))
                failures += failure_rows(name, realism, end)
                enough = enough and sum(each.success for each in judged(end)) >= 0.98 * len(judged(end))
    print("\n| application | realism | succeeded | success rate, 95 % at any time | most contact N | longest s |")
    print("|---|---|---:|---|---:|---:|\n" + "\n".join(rows))
    if failures:
        print("\n| application | realism | run | outcome | cause |\n|---|---|---:|---|---|\n" + "\n".join(failures))
    return 0 if enough else 1


if __name__ == "__main__":
    sys.exit(main())
