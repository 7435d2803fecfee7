"""`flexcell run`: executes one behavior and reports its result."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Literal

import typer

from engine.cell.open_cell import OpenCell
from engine.check import Finding, check_given, check_stored
from engine.cli.capture_option import Capture, capture_folder
from engine.cli.exit_code import ExitCode
from engine.cli.inputs import (
    Simulate,
    behavior_source,
    read_behavior,
    read_cell,
    read_inputs,
    read_parameters,
    read_simulated_cell,
    reload_plan,
)
from engine.cli.output.output_file import prepare
from engine.cli.output.run_junit import write_run_junit
from engine.cli.output.run_report import report_run
from engine.cli.store_access import author_name
from engine.cli.terminal.operator_options import Autonomy, Breakpoints, Demand, Loss, Operator, OperatorOptions, Paused
from engine.cli.terminal.run_execution import NO_JOURNAL, ExecutionResult, RunSetup, execute_run, new_relay
from engine.coverage import CoverageCollector
from engine.document import Behavior
from engine.document.cell import Cell, load_cell
from engine.document.faults import load_faults
from engine.document.substitutes import load_substitutes
from engine.errors import DocumentError
from engine.host.state_folder_names import STATE_FOLDER
from engine.project.cell_runner import CellRunner, CellSetup, PreparedRun
from engine.project.run_request import (
    RunRequest,
    RunStart,
    require_no_new_real_devices,
    require_simulation,
    start_at,
)
from engine.recording import DEFAULT_RATE_HZ, RecordingOptions, collect_documents
from engine.recording.recorded_run import RecordedRun, read_run
from engine.registry import load_states
from engine.runtime.plan import Catalogue, Plan, new_plan
from engine.skills.devices import LEAST_REASON, EnableDevice


def _in_words(reason: str | None) -> str | None:
    """Return why motion is permitted; raises BadParameter where nothing is said."""
    if reason is not None and len(reason.strip()) < LEAST_REASON:
        raise typer.BadParameter("say in words why it is permitted: it is logged")
    return reason


def run(
    file: Annotated[Path, typer.Argument(help="The behavior: YAML, JSON or FILE.py:NAME.", show_default=False)],
    cell: Annotated[
        Path | None, typer.Option(help="Cell in which it runs; by default the cell that the behavior names.")
    ] = None,
    simulate: Simulate = None,
    parameter: Annotated[
        list[str] | None,
        typer.Option("-p", "--parameter", help="Parameter of the behavior, NAME=VALUE; may be repeated."),
    ] = None,
    input_: Annotated[
        list[str] | None, typer.Option("--input", help="Initial userdata, KEY=JSON; may be repeated.")
    ] = None,
    clock: Annotated[
        Literal["virtual", "real"],
        typer.Option(help="virtual: as fast as the computer allows, and deterministic. real: in real time."),
    ] = "real",
    seed: Annotated[
        int | None,
        typer.Option(
            help="Seed of random choices and of the placement noise of parts; without a seed, no placement noise.",
            min=0,
        ),
    ] = None,
    journal: Annotated[str, typer.Option(help="Folder of the run journal, or `none`.")] = STATE_FOLDER,
    store: Annotated[
        str | None,
        typer.Option(help="Store used instead of the cell's: a file, or mongodb://HOST:PORT/DATABASE."),
    ] = None,
    events: Annotated[
        Path | None, typer.Option(help="Write the event log to this file, one JSON object per line.")
    ] = None,
    timeout: Annotated[float | None, typer.Option(help="Stop the run after this many seconds.", min=0.001)] = None,
    from_: Annotated[
        str | None,
        typer.Option("--from", help="RUN@SEQ: start with the data that this run of the journal had at event SEQ."),
    ] = None,
    at: Annotated[
        str | None, typer.Option(help="With --from: node to start at; by default the state entered last.")
    ] = None,
    enable: Annotated[
        str | None,
        typer.Option(
            help="Permit motion of all real devices of the cell first, with this reason for the log.",
            callback=_in_words,
        ),
    ] = None,
    capture: Capture = None,
    operator: Operator = False,
    autonomy: Autonomy = None,
    operator_loss: Loss = "hold",
    demand_operator: Demand = False,
    breakpoints: Breakpoints = False,
    paused: Paused = False,
    record: Annotated[
        Path | None, typer.Option(help="Record the run to this MCAP file, for Foxglove and `flexcell replay`.")
    ] = None,
    record_rate: Annotated[
        float, typer.Option(help="Maximum recorded rate of a topic, in messages per second; 0: events only.", min=0)
    ] = DEFAULT_RATE_HZ,
    record_topic: Annotated[
        list[str] | None,
        typer.Option(
            help="Record only topics whose name matches this pattern (`*` matches any text); may be repeated."
        ),
    ] = None,
    junit: Annotated[Path | None, typer.Option(help="Write the result to this file as JUnit XML.")] = None,
    faults: Annotated[Path | None, typer.Option(help="Inject the faults of this fault document.")] = None,
    substitutes: Annotated[
        Path | None,
        typer.Option(help="Replace nodes as this substitutes document defines."),
    ] = None,
    substitute_on_robots: Annotated[
        bool,
        typer.Option(
            "--substitute-on-robots", help="With --substitutes: allow substitutes in a cell with real robots."
        ),
    ] = False,
    coverage: Annotated[
        Path | None, typer.Option(help="Add the coverage of the run to this file; it is created if missing.")
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print the result as one JSON object on stdout, and no progress.")
    ] = False,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="Do not print progress.")] = False,
) -> None:
    """Run a behavior.

    Exit code 0: the outcome is a success. 1: any other outcome. 2: the run was not started.
    3: the run ended with an error, or a requested file could not be written at its end.
    130: interrupted; the robots are at rest and the journal is closed.
    """
    prepare(events, record, junit, coverage)
    catalogue = load_states(file)
    recorded = _read_recorded(from_, at, journal)
    named = read_simulated_cell(_named_cell(cell, recorded), file, simulate or _simulated_before(recorded))
    behavior = whole = read_valid_behavior(file, catalogue, cell=named, given=parameter or ())
    if substitutes is not None:
        behavior = behavior.with_substitutes(load_substitutes(substitutes))
    plan = new_plan(behavior, catalogue)
    options = OperatorOptions(
        autonomy=autonomy,
        operator=operator,
        loss=operator_loss,
        demand=demand_operator,
        breakpoints=breakpoints,
        paused=paused,
    )
    supervision = options.supervision(file)
    start = _read_start(recorded, at, plan)
    cell_spec = named or read_cell(None, behavior)
    require_simulation(plan, cell_spec, allowed=substitute_on_robots)
    if recorded is not None:
        require_no_new_real_devices(recorded[0], cell_spec)
    parameters = read_parameters(parameter or [], behavior.parameters)
    if start is not None and recorded is not None:
        parameters = start.parameters(plan, parameters)
        seed = recorded[0].origin.seed if seed is None else seed
        if cell_spec is not None:
            refuse_errors(check_given(behavior, catalogue, cell_spec, parameters))
    request = RunRequest(
        plan=plan,
        parameters=parameters,
        inputs=read_inputs(input_ or []),
        seed=seed or 0,
        supervision=supervision,
        faults=load_faults(faults) if faults is not None else None,
        start=start,
        restore_world=start is not None and start.knows_world,
        documents=collect_documents(behavior, cell_spec) if record is not None else None,
        source=behavior_source(file),
    )
    covered = CoverageCollector(whole, catalogue) if coverage is not None else None
    if covered is not None and coverage is not None:
        covered.require_same(coverage)
    virtual = clock == "virtual"
    setup = RunSetup(
        opened=CellSetup(
            cell=cell_spec,
            seed=seed,
            store=store,
            enabling=EnableDevice(reason=enable, by=author_name(None)) if enable else None,
            capture=capture_folder(capture),
            relay=new_relay(cell_spec, virtual=virtual),
            journal=journal if journal != NO_JOURNAL else None,
            recording=RecordingOptions(
                path=record,
                documents=request.documents,
                rate_hz=record_rate,
                topics=tuple(record_topic or ("*",)),
            )
            if record is not None and request.documents is not None
            else None,
        ),
        start=partial(_start, request, catalogue),
        timeout_s=timeout,
        virtual=virtual,
        quiet=quiet or json,
        supervision=supervision,
        watchers=(covered.follow(),) if covered is not None else (),
        reload=partial(reload_plan, file, catalogue, cell=cell_spec, substitutes=behavior.substitutes)
        if operator
        else None,
    )

    def report(ended: ExecutionResult) -> None:
        report_run(ended.result, ended.log, ended.measures, as_json=json, events=events)
        if covered is not None and coverage is not None:
            covered.accumulate(coverage)
        if junit is not None:
            write_run_junit(junit, file, plan, ended.result, seed=seed, clock=clock)

    raise typer.Exit(execute_run(setup, report=report))


async def _start(request: RunRequest, catalogue: Catalogue, runner: CellRunner) -> PreparedRun:
    await _warn_missing_entries(request.plan, catalogue, runner.cell)
    return await runner.start(request)


async def _warn_missing_entries(plan: Plan, catalogue: Catalogue, cell: OpenCell) -> None:
    """Warn of named entries missing in the store; the behavior may still write them before it reads them."""
    if cell.store is not None and plan.source is not None:
        for finding in check_stored(plan.source, catalogue, [(key.kind, key.name) for key in await cell.store.list()]):
            sys.stderr.write(f"{finding}\n")


def _read_recorded(text: str | None, at: str | None, journal: str) -> tuple[RecordedRun, int] | None:
    if text is None:
        if at is not None:
            raise DocumentError("--at requires --from", hint="such as --from RUN@120")
        return None
    run_id, _, number = text.rpartition("@")
    if not run_id or not number.isdecimal():
        raise DocumentError(f"{text!r} is not RUN@SEQ", where="--from", hint="`flexcell runs show RUN --events`")
    return read_run(journal, run_id), int(number)


def _read_start(recorded: tuple[RecordedRun, int] | None, at: str | None, plan: Plan) -> RunStart | None:
    if recorded is None:
        return None
    earlier, seq = recorded
    start = start_at(earlier, plan, seq=seq, path=at)
    if earlier.world is not None and not start.knows_world:
        known = earlier.world.seq
        sys.stderr.write(f"flexcell: the cell is not restored: its world is known at event {known} only\n")
    elif earlier.world is None and earlier.origin.cell is not None:
        sys.stderr.write("flexcell: the cell is not restored: the journal holds no state of its world\n")
    return start


def _simulated_before(recorded: tuple[RecordedRun, int] | None) -> tuple[str, ...]:
    """Return the devices that were simulated in the run to start from."""
    return recorded[0].origin.simulated if recorded is not None else ()


def _named_cell(file: Path | None, recorded: tuple[RecordedRun, int] | None) -> Cell | None:
    """Return the cell of the command line, else that of the run to start from; None for that of the behavior."""
    if file is None and recorded is not None and recorded[0].origin.cell is not None:
        file = Path(recorded[0].origin.cell)
    return load_cell(file) if file is not None else None


def read_valid_behavior(
    file: Path, catalogue: Catalogue, *, cell: Cell | None = None, given: Sequence[str] = ()
) -> Behavior:
    """Load a behavior; if it has errors in the cell in which it runs, print them all and end the command.

    Raises:
        DocumentError: the behavior cannot be read.
    """
    behavior, findings = read_behavior(file, catalogue, cell=cell, given=given)
    refuse_errors(findings)
    return behavior


def refuse_errors(findings: tuple[Finding, ...]) -> None:
    """Print the findings that prevent a run, and end the command when there are any."""
    errors = [finding for finding in findings if finding.severity == "error"]
    for finding in errors:
        sys.stderr.write(f"{finding}\n")
    if errors:
        raise typer.Exit(ExitCode.BAD_INPUT)
