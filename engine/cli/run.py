"""`flexcell run`: executes one behavior and says how it ended."""

from __future__ import annotations

import asyncio
import signal
import sys
import time
from collections.abc import Coroutine
from contextlib import AbstractAsyncContextManager, ExitStack, nullcontext
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import msgspec
import typer
from rich.console import Console

from engine.cause import describe
from engine.cell import OpenCell
from engine.check import Finding
from engine.cli.exit_code import ExitCode
from engine.cli.inputs import read_behavior, read_cell, read_inputs, read_parameters
from engine.cli.progress import Progress
from engine.cli.run_junit import write_run_junit
from engine.clock import run_virtual
from engine.document.cell import Cell
from engine.event import Event
from engine.journal import Journal, NullJournal, encode_event_log
from engine.plan import Plan, new_plan
from engine.recording import DEFAULT_RATE_HZ, RecordingOrder, RunRecording, collect_documents
from engine.registry import load_states
from engine.run import Run, RunResult
from engine.run_id import new_run_id

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class _Order:
    """Everything a run needs to know, read and checked before anything starts."""

    plan: Plan
    cell: Cell | None
    parameters: dict[str, object]
    inputs: dict[str, object]
    seed: int | None
    journal: str
    store: str | None
    timeout_s: float | None
    virtual: bool
    quiet: bool
    recording: RecordingOrder | None = None


def run(
    file: Annotated[Path, typer.Argument(help="The behavior, a YAML or JSON file.", show_default=False)],
    cell: Annotated[
        Path | None, typer.Option(help="The cell to run it in; the one the behavior names by default.")
    ] = None,
    parameter: Annotated[
        list[str] | None, typer.Option("-p", "--parameter", help="A parameter, name=value; may be repeated.")
    ] = None,
    input_: Annotated[
        list[str] | None, typer.Option("--input", help="A userdata key, key=JSON; may be repeated.")
    ] = None,
    clock: Annotated[
        Literal["virtual", "real"], typer.Option(help="virtual: as fast as the machine allows, and repeatable.")
    ] = "real",
    seed: Annotated[
        int | None,
        typer.Option(help="Seed of random choices and of the jitter of parts; parts lie exactly without one.", min=0),
    ] = None,
    journal: Annotated[str, typer.Option(help="Directory of the journal of runs, or `none`.")] = ".flexcell",
    store: Annotated[str | None, typer.Option(help="Use this store file instead of the cell's.")] = None,
    events: Annotated[Path | None, typer.Option(help="Write the event log here, one JSON object a line.")] = None,
    timeout: Annotated[float | None, typer.Option(help="Stop the run after this many seconds.", min=0.001)] = None,
    record: Annotated[
        Path | None, typer.Option(help="Record the run in this MCAP file, for Foxglove and `flexcell replay`.")
    ] = None,
    record_rate: Annotated[
        float, typer.Option(help="At most that many messages of a topic a second are recorded; 0: events only.", min=0)
    ] = DEFAULT_RATE_HZ,
    record_topic: Annotated[
        list[str] | None,
        typer.Option(help="Record only topics with this name, may hold `*`; may be repeated."),
    ] = None,
    junit: Annotated[Path | None, typer.Option(help="Write the result here as JUnit XML.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout, nothing else.")] = False,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="Show no progress.")] = False,
) -> None:
    """Run a behavior.

    Exit code 0: its outcome is a success. 1: another outcome. 2: nothing was started.
    3: it ended with an error. 130: interrupted; robots are at rest and the journal is closed.
    """
    catalogue = load_states()
    behavior, findings = read_behavior(file, catalogue)
    _refuse_errors(findings)
    opened = read_cell(cell, behavior)
    order = _Order(
        plan=new_plan(behavior, catalogue),
        cell=opened,
        parameters=read_parameters(parameter or [], behavior.parameters),
        inputs=read_inputs(input_ or []),
        seed=seed,
        journal=journal,
        store=store,
        timeout_s=timeout,
        virtual=clock == "virtual",
        quiet=quiet or json,
        recording=RecordingOrder(
            path=record,
            documents=collect_documents(behavior, opened),
            rate_hz=record_rate,
            topics=tuple(record_topic or ("*",)),
        )
        if record is not None
        else None,
    )
    log: list[Event] = []
    result, interrupted = _on_clock(_execute(order, log), virtual=order.virtual)
    encoded = encode_event_log(log)
    if events is not None:
        events.write_bytes(encoded)
    if junit is not None:
        write_run_junit(junit, file, order.plan, result, seed=seed, clock=clock)
    if json:
        _print_json(result, encoded, len(log))
    else:
        _print_result(result)
    raise typer.Exit(ExitCode.INTERRUPTED if interrupted else exit_code(result))


def exit_code(result: RunResult) -> ExitCode:
    """Return what the process says of a run that was not interrupted."""
    if result.status == "errored":
        return ExitCode.ERRORED
    return ExitCode.SUCCESS if result.success else ExitCode.OTHER_OUTCOME


def _on_clock(main: Coroutine[Any, Any, T], *, virtual: bool) -> T:
    return run_virtual(main) if virtual else asyncio.run(main)


class _Interruption:
    """What a signal asks for, whether it comes before the run is made or while it goes on."""

    def __init__(self) -> None:
        self.reason = ""
        self._run: Run | None = None

    def signal(self, name: str) -> None:
        """Stop the run, or the run to come."""
        self.reason = f"interrupted by {name}"
        if self._run is not None:
            self._run.stop(self.reason)

    def watch_over(self, run: Run) -> None:
        """Stop `run` at the next signal, or at once when there was one."""
        self._run = run
        if self.reason:
            run.stop(self.reason)


async def _execute(order: _Order, log: list[Event]) -> tuple[RunResult, bool]:
    interruption = _Interruption()
    with ExitStack() as stack:
        loop = asyncio.get_running_loop()
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, interruption.signal, number.name)
            stack.callback(loop.remove_signal_handler, number)
        journal = _journal(order, stack)
        async with (
            _recording(order) as recording,
            OpenCell(order.cell, seed=order.seed, store_path=order.store) as cell,
        ):
            started_unix_s = time.time()
            run = _new_run(order, cell, journal)
            if recording is not None:
                recording.attach(run, cell.bus, started_unix_s=started_unix_s, inputs=order.inputs)
            run.watch(log.append)
            if not order.quiet:
                run.watch(Progress(Console(stderr=True)).show)
            interruption.watch_over(run)
            result = await _within(order.timeout_s, run)
    return result, bool(interruption.reason)


def _new_run(order: _Order, cell: OpenCell, journal: Journal | NullJournal) -> Run:
    run_id = new_run_id(order.plan.name)
    entry = journal.begin(
        run_id, behavior=order.plan.name, document=order.plan.document_hash, started_unix_s=time.time()
    )
    return Run(
        order.plan,
        run=run_id,
        bus=cell.bus,
        parameters=order.parameters,
        inputs=order.inputs,
        seed=order.seed or 0,
        journal=entry,
    )


async def _within(timeout_s: float | None, execution: Run) -> RunResult:
    if timeout_s is None:
        return await execution.execute()
    loop = asyncio.get_running_loop()
    timer = loop.call_later(timeout_s, execution.stop, f"it took longer than {timeout_s:g} s")
    try:
        return await execution.execute()
    finally:
        timer.cancel()


def _recording(order: _Order) -> AbstractAsyncContextManager[RunRecording | None]:
    if order.recording is None:
        return nullcontext()
    return RunRecording.open(order.recording, inline=order.virtual)


def _journal(order: _Order, stack: ExitStack) -> Journal | NullJournal:
    if order.journal == "none":
        return NullJournal()
    return stack.enter_context(Journal.open(order.journal, inline=order.virtual))


def _refuse_errors(findings: tuple[Finding, ...]) -> None:
    errors = [finding for finding in findings if finding.severity == "error"]
    for finding in errors:
        sys.stderr.write(f"{finding}\n")
    if errors:
        raise typer.Exit(ExitCode.BAD_INPUT)


def _print_json(result: RunResult, encoded: bytes, count: int) -> None:
    chain = result.cause.chain() if result.cause else ()
    document = {
        "run": result.run,
        "behavior": result.behavior,
        "status": result.status,
        "outcome": result.outcome,
        "success": result.success,
        "cause": [{"message": link.message, "where": link.where, "kind": link.kind, "nodes": link.nodes} for link in chain],
        "duration_s": result.duration_s,
        "events": count,
        "events_sha256": sha256(encoded).hexdigest(),
        "userdata": result.userdata,
    }
    sys.stdout.write(msgspec.json.encode(document).decode() + "\n")


def _print_result(result: RunResult) -> None:
    console = Console(stderr=True)
    style = "green" if result.success else "red"
    what = result.outcome or result.status
    console.print(f"[bold {style}]{what}[/] after {result.duration_s:.2f} s [dim](run {result.run})[/]")
    if result.cause is not None and not result.success:
        for depth, link in enumerate(result.cause.chain()):
            console.print(f"{'  ' * depth}because {describe_link(link)}", markup=False, highlight=False, soft_wrap=True)
            for node in link.nodes:
                console.print(f"{'  ' * depth}        in {node}", markup=False, highlight=False, soft_wrap=True)


def describe_link(link: Any) -> str:
    """Write one link of a cause chain without what is below it."""
    return describe(msgspec.structs.replace(link, because=None))
