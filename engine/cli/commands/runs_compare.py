"""`flexcell runs compare` and `trend`: what differs between two runs, and how the last runs of a behavior went."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import msgspec
import typer

from engine.archive import Archive, ArchivedRun, RunTrends, compare_runs
from engine.cli.output.comparison_output import print_comparison, print_trend
from engine.document import load_behavior
from engine.errors import DocumentError, JournalError
from engine.host.state_folder_names import STATE_FOLDER
from engine.registry import load_states
from engine.suggestions import did_you_mean

JournalPlace = Annotated[Path, typer.Option("--journal", help="Folder of the run journal.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


def compare(
    runs: Annotated[
        list[str],
        typer.Argument(
            help="Two runs: ids, see `flexcell runs`, or recordings of this project. One run is compared with the last"
            " run of its behavior before it that succeeded.",
            show_default=False,
        ),
    ],
    journal: JournalPlace = Path(STATE_FOLDER),
    json: AsJson = False,
) -> None:
    """Compare two runs: where they first diverge, settings, documents, durations, values that were read and written.

    Visits of nodes are aligned, container by container. Durations and values are written `left → right`.
    """
    archive = _archive(journal)
    left, right = _two(archive, runs)
    comparison = compare_runs(left, right)
    if json:
        sys.stdout.write(msgspec.json.encode(comparison).decode() + "\n")
    else:
        print_comparison(comparison)


def trend(
    behavior: Annotated[
        str, typer.Argument(help="Behavior: its name, see `flexcell runs`, or its document.", show_default=False)
    ],
    last: Annotated[int, typer.Option(help="Number of runs, at most.", min=1, max=1000)] = 20,
    journal: JournalPlace = Path(STATE_FOLDER),
    json: AsJson = False,
) -> None:
    """Show how the last runs of a behavior went: how many succeeded, and how long they and their nodes took.

    Durations are those of runs that succeeded: median, quartiles, extremes, and beside them that of the latest run.
    """
    archive = _archive(journal)
    file = Path(behavior)
    name = load_behavior(file).name if file.suffix in (".yaml", ".yml", ".json") else behavior
    found = RunTrends(archive).of(name, last=last)
    if not found.known:
        known = sorted({run.behavior for run in archive.runs()})
        raise JournalError(
            f"the journal has no run of {name!r}", where=archive.journal, hint=did_you_mean(name, known) or None
        )
    if json:
        sys.stdout.write(msgspec.json.encode(found).decode() + "\n")
    else:
        print_trend(found)


def _archive(journal: Path) -> Archive:
    return Archive(Path.cwd(), load_states(Path.cwd()), journal)


def _two(archive: Archive, names: list[str]) -> tuple[ArchivedRun, ArchivedRun]:
    if len(names) > 2:
        raise DocumentError(f"{len(names)} runs are given", hint="give two, or one")
    right = archive.open(names[-1])
    if len(names) == 2:
        return archive.open(names[0]), right
    good = archive.last_good_run(right.summary)
    if good is None:
        raise JournalError(
            f"no run of {right.summary.behavior!r} before {right.summary.id} succeeded",
            where=archive.journal,
            hint="give the run to compare it with",
        )
    return archive.open(good.id), right
