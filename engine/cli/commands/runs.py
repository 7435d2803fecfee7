"""`flexcell runs`: lists the runs of a journal, shows the state of one, compares two, and shows trends."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from rich.console import Console
from rich.table import Column, Table

from engine.archive import Archive, ArchivedRun, RunTrends, compare_runs
from engine.cause_chain import describe_cause
from engine.cli.output.comparison_output import print_comparison, print_trend
from engine.cli.output.run_report import cause_links, print_cause
from engine.document import load_behavior
from engine.errors import Cause, DocumentError, JournalError
from engine.event import Event, OperatorChanged, OperatorCommanded, RunEnded, StopRequested
from engine.host.state_folder_names import STATE_FOLDER
from engine.journal import JournalSnapshot, RunRecord, encode_event, journal_path, open_snapshot
from engine.recording.recorded_run import RecordedRun, read_run
from engine.registry import load_states
from engine.runtime.history.event_texts import event_text
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.history.resume import read_history
from engine.runtime.history.run_view import run_duration_s
from engine.runtime.plan import new_plan
from engine.wording.suggestions import did_you_mean

_LAST_EVENTS = 10
_PIPE_WIDTH = 200

app = typer.Typer(
    help="List the runs of a journal, show the state of one, compare two, and show trends.",
    invoke_without_command=True,
)

JournalPlace = Annotated[str, typer.Option("--journal", help="Folder of the run journal.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


class RunListEntry(msgspec.Struct, frozen=True, kw_only=True):
    """One run in the list; `status` is running, interrupted, finished, stopped, errored or damaged.

    `verified` is false if an older version, which wrote no checksums, wrote part of the run.
    """

    id: str
    behavior: str
    status: str
    started: str
    duration_s: float | None
    """The time of its last event on its clock; null where the run is damaged."""
    events: int
    engines: int
    verified: bool
    damage: str


class RunSummary(RunListEntry, frozen=True, kw_only=True):
    """State of one run at its last durable event, and the actions of its operator."""

    outcome: str | None
    cause: list[dict[str, object]]
    active: tuple[str, ...]
    userdata: dict[str, object]
    scopes: dict[str, dict[str, object]]
    parameters: dict[str, object]
    operator: list[Event]
    last: list[Event]
    world_at: int | None
    """Event at which the state of the simulated world is known."""


@app.callback()
def runs(context: typer.Context, journal: JournalPlace = STATE_FOLDER, json: AsJson = False) -> None:
    """List the runs, oldest first; a run whose process died is listed as interrupted."""
    if context.invoked_subcommand is not None:
        return
    with open_snapshot(journal_path(journal)) as snapshot:
        lines = [_line(record, _duration_s(snapshot, record.id)) for record in snapshot.runs()]
    if json:
        sys.stdout.write(msgspec.json.encode(lines).decode() + "\n")
        return
    # Users copy the id: it is never truncated.
    widest = max((len(line.id) for line in lines), default=0)
    run_column = Column("run", min_width=widest, no_wrap=True)
    table = Table(
        run_column, "behavior", "status", "started (UTC)", Column("duration", justify="right"), "events", box=None
    )
    for line in lines:
        table.add_row(line.id, line.behavior, line.status, line.started, _duration_text(line), str(line.events))
    # In a pipe no text is wrapped or truncated: the reader searches for whole words.
    Console(width=None if sys.stdout.isatty() else _PIPE_WIDTH).print(table)
    for line in lines:
        if line.damage:
            print(f"flexcell: {line.id}: {line.damage}", file=sys.stderr)
    old = [line.id for line in lines if not line.verified]
    if old:
        print(f"flexcell: unverified, written by an older version: {', '.join(old)}", file=sys.stderr)


@app.command("show")
def show(
    run: Annotated[str, typer.Argument(help="Id of the run, see `flexcell runs`.", show_default=False)],
    journal: JournalPlace = STATE_FOLDER,
    events: Annotated[
        bool, typer.Option("--events", help="Print all events of the run, one JSON object per line.")
    ] = False,
    json: AsJson = False,
) -> None:
    """Show the state of a run: active states, data, actions of the operator, and why it ended."""
    found = read_run(journal, run)
    if events:
        for event in found.events:
            sys.stdout.buffer.write(encode_event(event) + b"\n")
        return
    summary = _summary(found)
    if json:
        sys.stdout.write(msgspec.json.encode(summary).decode() + "\n")
    else:
        _print(summary, _end(found))


@app.command("compare")
def compare(
    runs: Annotated[
        list[str],
        typer.Argument(
            help="Two runs: ids, see `flexcell runs`, or recordings of this project. One run is compared with the last"
            " run of its behavior before it that succeeded.",
            show_default=False,
        ),
    ],
    journal: JournalPlace = STATE_FOLDER,
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


@app.command("trend")
def trend(
    behavior: Annotated[
        str, typer.Argument(help="Behavior: its name, see `flexcell runs`, or its document.", show_default=False)
    ],
    last: Annotated[int, typer.Option(help="Number of runs, at most.", min=1, max=1000)] = 20,
    journal: JournalPlace = STATE_FOLDER,
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


def _duration_s(snapshot: JournalSnapshot, run_id: str) -> float | None:
    try:
        return run_duration_s(snapshot.last_event(run_id))
    except JournalError:
        # A damaged run must not hide the others.
        return None


def _duration_text(line: RunListEntry) -> str:
    return "" if line.duration_s is None else f"{line.duration_s:.2f} s"


def _line(record: RunRecord, duration_s: float | None) -> RunListEntry:
    return RunListEntry(
        id=record.id,
        behavior=record.behavior,
        status="damaged" if record.damage else "interrupted" if record.interrupted else record.status,
        started=datetime.fromtimestamp(record.started_unix_s, UTC).strftime("%Y-%m-%d %H:%M:%S"),
        duration_s=duration_s,
        events=record.last_seq,
        engines=record.epoch,
        verified=record.verified,
        damage=record.damage,
    )


def _summary(found: RecordedRun) -> RunSummary:
    line = _line(found.record, run_duration_s(found.events[-1] if found.events else None))
    history = _history(found)
    end = _end(found)
    return RunSummary(
        **msgspec.structs.asdict(line),
        outcome=end.outcome if end is not None else None,
        cause=cause_links(end.cause if end is not None else None),
        active=history.active if history is not None and not history.state.ended else (),
        userdata=dict(history.userdata()) if history is not None else {},
        scopes={path: dict(values) for path, values in history.scopes().items() if path and values}
        if history is not None
        else {},
        parameters=history.state.parameters if history is not None else found.origin.parameters,
        operator=[
            event for event in found.effective if isinstance(event, OperatorCommanded | OperatorChanged | StopRequested)
        ],
        last=list(found.effective[-_LAST_EVENTS:]),
        world_at=found.world.seq if found.world is not None else None,
    )


def _end(found: RecordedRun) -> RunEnded | None:
    last = found.events[-1] if found.events else None
    return last if isinstance(last, RunEnded) else None


def _history(found: RecordedRun) -> ResumableState | None:
    """Return the state of the run; the journal itself holds the behavior that it executed."""
    behavior = found.behavior()
    if behavior is None:
        return None
    try:
        plan = new_plan(behavior, load_states(Path.cwd()))
    except DocumentError as error:
        # A run of another project, whose states are not installed here: its events can still be shown.
        sys.stderr.write(f"flexcell: userdata is not shown: {error}\n")
        return None
    return read_history(plan, found.id, found.events)


def _print(summary: RunSummary, end: RunEnded | None) -> None:
    console = Console(soft_wrap=True, highlight=False, markup=False)
    ended = f" with {summary.outcome}" if summary.outcome else ""
    engines = f", {summary.engines} engines" if summary.engines > 1 else ""
    console.print(f"{summary.id}: {summary.behavior}, {summary.status}{ended}")
    console.print(f"started {summary.started} UTC, {_duration_text(summary)}, {summary.events} events{engines}")
    if not summary.verified:
        console.print("unverified: an older version, which wrote no checksums, wrote part of this run")
    if summary.world_at is not None:
        console.print(f"the simulated world is known at event {summary.world_at}")
    cause: Cause | None = end.cause if end is not None else None
    print_cause(cause, console)
    _print_values(console, "parameters", summary.parameters)
    _print_values(console, "userdata", summary.userdata)
    for path, values in summary.scopes.items():
        _print_values(console, f"userdata of {path}", values)
    if summary.active:
        console.print("active:")
        for path in summary.active:
            console.print(f"  {path}")
    _print_events(console, "operator:", summary.operator)
    _print_events(console, "last events:", summary.last)


def _print_values(console: Console, title: str, values: dict[str, object]) -> None:
    if values:
        console.print(f"{title}:")
    for key, value in values.items():
        console.print(f"  {key} = {msgspec.json.encode(value).decode()}")


def _print_events(console: Console, title: str, events: Sequence[Event]) -> None:
    if events:
        console.print(title)
    for event in events:
        console.print(f"  {event.seq:6} {event.time_s:9.3f} s  {_event_line(event)}")


def _event_line(event: Event) -> str:
    shown = event_text(event)
    why = f": {describe_cause(shown.cause)}" if shown.cause is not None else ""
    return f"{shown.path}  {shown.text}{why}" if shown.path else f"{shown.text}{why}"


def _archive(journal: str) -> Archive:
    return Archive(Path.cwd(), load_states(Path.cwd()), Path(journal))


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
