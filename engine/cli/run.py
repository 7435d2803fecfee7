"""`flexcell run`: executes one behavior and says how it ended."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Literal

import typer

from engine.cell.open_cell import OpenCell
from engine.check import Finding, check_given, check_stored
from engine.cli.exit_code import ExitCode
from engine.cli.inputs import behavior_source, read_behavior, read_cell, read_inputs, read_parameters, reload_plan
from engine.cli.operator_options import Autonomy, Breakpoints, Demand, Loss, Operator, OperatorOptions, Paused
from engine.cli.output_file import prepare, write
from engine.cli.run_execution import ExecutionResult, MakeRun, RunSetup, execute_run
from engine.cli.run_junit import write_run_junit
from engine.cli.run_report import print_json, print_result
from engine.coverage import CoverageCollector
from engine.document import Behavior
from engine.document.cell import Cell, load_cell
from engine.document.faults import load_faults
from engine.document.substitutes import load_substitutes
from engine.errors import DocumentError
from engine.host.state_folder_names import STATE_FOLDER
from engine.journal import Journal, NullJournal, encode_event_log
from engine.project.run_factory import checkpoint_at, new_origin, new_run, require_simulation
from engine.recording import DEFAULT_RATE_HZ, RecordingOptions, collect_documents
from engine.recording.recorded_run import RecordedRun, read_run
from engine.registry import load_states
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.plan import Catalogue, Plan, new_plan
from engine.runtime.record.skill_port import SkillPort
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions


@dataclass(frozen=True, kw_only=True)
class _RunPosition:
    """The moment of another run to begin at."""

    found: RecordedRun
    seq: int
    checkpoint: Checkpoint

    @property
    def restores(self) -> bool:
        """Whether the simulated world is known as it was at that moment."""
        return self.found.knows_world_at(self.seq)


def run(
    file: Annotated[Path, typer.Argument(help="The behavior: YAML, JSON or FILE.py:NAME.", show_default=False)],
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
    journal: Annotated[str, typer.Option(help="Directory of the journal of runs, or `none`.")] = STATE_FOLDER,
    store: Annotated[
        str | None, typer.Option(help="Use this store instead of the cell's: a file, or mongodb://HOST:PORT/DATABASE.")
    ] = None,
    events: Annotated[Path | None, typer.Option(help="Write the event log here, one JSON object a line.")] = None,
    timeout: Annotated[float | None, typer.Option(help="Stop the run after this many seconds.", min=0.001)] = None,
    from_: Annotated[
        str | None, typer.Option("--from", help="RUN@SEQ: begin with the data of that event of a run in the journal.")
    ] = None,
    at: Annotated[
        str | None, typer.Option(help="With --from: the node to begin at; the state entered last by default.")
    ] = None,
    operator: Operator = False,
    autonomy: Autonomy = None,
    operator_loss: Loss = "hold",
    demand_operator: Demand = False,
    breakpoints: Breakpoints = False,
    paused: Paused = False,
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
    faults: Annotated[Path | None, typer.Option(help="Let go wrong what this fault document says.")] = None,
    substitutes: Annotated[
        Path | None,
        typer.Option(help="Let something else stand in for the nodes that this document names."),
    ] = None,
    substitute_on_robots: Annotated[
        bool, typer.Option("--substitute-on-robots", help="With --substitutes: also where a robot is real.")
    ] = False,
    coverage: Annotated[
        Path | None, typer.Option(help="Add what was covered of the behavior to this file; it is made at first.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout, nothing else.")] = False,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="Show no progress.")] = False,
) -> None:
    """Run a behavior.

    Exit code 0: its outcome is a success. 1: another outcome. 2: nothing was started.
    3: it ended with an error, or a file that was asked for could not be written in the end.
    130: interrupted; robots are at rest and the journal is closed.
    """
    prepare(events, record, junit, coverage)
    catalogue = load_states(file)
    recorded = _read_recorded(from_, at, journal)
    place = _named_cell(cell, recorded)
    behavior = whole = read_valid_behavior(file, catalogue, cell=place, given=parameter or ())
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
    opened = place or read_cell(None, behavior)
    require_simulation(plan, opened, allowed=substitute_on_robots)
    parameters = read_parameters(parameter or [], behavior.parameters)
    if start is not None:
        known = {name: value for name, value in start.checkpoint.parameters.items() if name in plan.parameters}
        parameters = {**known, **parameters}
        seed = start.found.origin.seed if seed is None else seed
        if opened is not None:
            refuse_errors(check_given(behavior, catalogue, opened, parameters))
    inputs = read_inputs(input_ or [])
    covered = CoverageCollector(whole, catalogue) if coverage is not None else None
    if covered is not None and coverage is not None:
        covered.require_same(coverage)
    order = RunSetup(
        make=_maker(
            behavior,
            plan,
            source=behavior_source(file),
            parameters=parameters,
            inputs=inputs,
            seed=seed,
            supervision=supervision,
            start=start,
            catalogue=catalogue,
        ),
        cell=opened,
        seed=seed,
        journal=journal,
        store=store,
        timeout_s=timeout,
        virtual=clock == "virtual",
        quiet=quiet or json,
        supervision=supervision,
        inputs=inputs,
        recording=RecordingOptions(
            path=record,
            documents=collect_documents(behavior, opened),
            rate_hz=record_rate,
            topics=tuple(record_topic or ("*",)),
        )
        if record is not None
        else None,
        faults=load_faults(faults) if faults is not None else None,
        watchers=(covered.follow(),) if covered is not None else (),
        reload=partial(reload_plan, file, catalogue, cell=opened, substitutes=behavior.substitutes)
        if operator
        else None,
    )

    def report(ended: ExecutionResult) -> None:
        encoded = encode_event_log(ended.log)
        if json:
            print_json(ended.result, encoded, len(ended.log))
        else:
            print_result(ended.result)
        if events is not None:
            write(events, encoded)
        if covered is not None and coverage is not None:
            covered.accumulate(coverage)
        if junit is not None:
            write_run_junit(junit, file, plan, ended.result, seed=seed, clock=clock)

    raise typer.Exit(execute_run(order, report=report))


def _maker(
    behavior: Behavior,
    plan: Plan,
    *,
    source: str | None,
    parameters: dict[str, object],
    inputs: dict[str, object],
    seed: int | None,
    supervision: RunOptions,
    start: _RunPosition | None,
    catalogue: Catalogue,
) -> MakeRun:
    async def make(cell: OpenCell, journal: Journal | NullJournal, skills: SkillPort | None) -> Run:
        await _say_what_is_missing(behavior, catalogue, cell)
        if start is not None and start.restores and start.found.world is not None:
            await cell.restore(start.found.world.data)
        return new_run(
            plan,
            cell=cell,
            journal=journal,
            parameters=parameters,
            inputs=inputs,
            seed=seed or 0,
            origin=new_origin(behavior, cell=cell, supervision=supervision, source=source),
            supervision=supervision,
            skills=skills,
            checkpoint=start.checkpoint if start is not None else None,
        )

    return make


async def _say_what_is_missing(behavior: Behavior, catalogue: Catalogue, cell: OpenCell) -> None:
    """Warn of named entries that the store does not hold; the behavior may still write them before it needs them."""
    if cell.store is not None:
        for finding in check_stored(behavior, catalogue, [(key.kind, key.name) for key in await cell.store.list()]):
            sys.stderr.write(f"{finding}\n")


def _read_recorded(text: str | None, at: str | None, journal: str) -> tuple[RecordedRun, int] | None:
    if text is None:
        if at is not None:
            raise DocumentError("--at needs --from", hint="such as --from RUN@120")
        return None
    run_id, _, number = text.rpartition("@")
    if not run_id or not number.isdecimal():
        raise DocumentError(f"{text!r} is not RUN@SEQ", where="--from", hint="`flexcell runs show RUN --events`")
    return read_run(journal, run_id), int(number)


def _read_start(recorded: tuple[RecordedRun, int] | None, at: str | None, plan: Plan) -> _RunPosition | None:
    if recorded is None:
        return None
    found, seq = recorded
    start = _RunPosition(found=found, seq=seq, checkpoint=checkpoint_at(found, plan, seq=seq, path=at))
    if found.world is not None and not start.restores:
        known = found.world.seq
        sys.stderr.write(f"flexcell: the cell starts as it is: its world is known at event {known} only\n")
    elif found.world is None and found.origin.cell is not None:
        sys.stderr.write("flexcell: the cell starts as it is\n")
    return start


def _named_cell(file: Path | None, recorded: tuple[RecordedRun, int] | None) -> Cell | None:
    """Return the cell of the command line, else that of the run to begin with; None for that of the behavior."""
    if file is None and recorded is not None and recorded[0].origin.cell is not None:
        file = Path(recorded[0].origin.cell)
    return load_cell(file) if file is not None else None


def read_valid_behavior(
    file: Path, catalogue: Catalogue, *, cell: Cell | None = None, given: Sequence[str] = ()
) -> Behavior:
    """Load a behavior; one that has errors in the cell where it is to run ends the command with all of them.

    Raises:
        DocumentError: it cannot be read at all.
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
