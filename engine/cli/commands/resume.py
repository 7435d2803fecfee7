"""`flexcell resume`: resumes a run whose process died, from its last durable event."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Literal

import typer

from engine.authoring.python_file import load_python_behavior
from engine.cli.exit_code import ExitCode
from engine.cli.inputs import read_plan, reload_plan
from engine.cli.output.output_file import prepare
from engine.cli.output.run_report import report_run
from engine.cli.terminal.operator_options import Autonomy, Breakpoints, Demand, Loss, Operator, OperatorOptions, Paused
from engine.cli.terminal.run_execution import NO_JOURNAL, ExecutionResult, RunSetup, execute_run, new_relay
from engine.document.cell import Cell, load_cell
from engine.document.python_name import is_python_name
from engine.document.simulated_devices import with_simulated_devices
from engine.document.state_catalogue import StateCatalogue
from engine.errors import ControlError
from engine.host.state_folder_names import STATE_FOLDER
from engine.project.cell_runner import CellRunner, CellSetup
from engine.project.resume_plan import ResumePlan, plan_resume
from engine.project.run_request import require_no_new_real_devices, require_simulation
from engine.recording.recorded_run import RecordedRun, read_run
from engine.registry import load_states
from engine.runtime.history.resume import RERUN, ResumeDecisionRequired


def resume(
    run: Annotated[str, typer.Argument(help="Id of the run, see `flexcell runs`.", show_default=False)],
    journal: Annotated[str, typer.Option(help="Folder of the run journal.")] = STATE_FOLDER,
    answer: Annotated[
        list[str] | None,
        typer.Option(
            help="PATH=rerun or PATH=OUTCOME: how to resume a state that was active; may be repeated.",
        ),
    ] = None,
    changed: Annotated[
        bool, typer.Option("--changed", help="Resume with the current file of the behavior, if the change permits it.")
    ] = False,
    behavior: Annotated[Path | None, typer.Option(help="File of the behavior, if it has moved since the run.")] = None,
    cell: Annotated[Path | None, typer.Option(help="File of the cell, if it has moved since the run.")] = None,
    clock: Annotated[
        Literal["virtual", "real"] | None, typer.Option(help="Clock of the run; by default the one it started with.")
    ] = None,
    take_over: Annotated[
        bool,
        typer.Option("--take-over", help="Resume even if another process executes the run; that process is stopped."),
    ] = False,
    events: Annotated[
        Path | None, typer.Option(help="Write the new events to this file, one JSON object per line.")
    ] = None,
    timeout: Annotated[float | None, typer.Option(help="Stop the run after this many seconds.", min=0.001)] = None,
    substitute_on_robots: Annotated[
        bool,
        typer.Option("--substitute-on-robots", help="Allow the substitutes of the run in a cell with real robots."),
    ] = False,
    operator: Operator = False,
    autonomy: Autonomy = None,
    operator_loss: Loss = "hold",
    demand_operator: Demand = False,
    breakpoints: Breakpoints = False,
    paused: Paused = False,
    json: Annotated[
        bool, typer.Option("--json", help="Print the result as one JSON object on stdout, and no progress.")
    ] = False,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="Do not print progress.")] = False,
) -> None:
    """Resume an interrupted run.

    Nodes that had ended are not executed again. A state that was active follows its `resume` policy; for
    the policy `ask`, the terminal asks or --answer decides. The exit codes are those of `run`.
    """
    prepare(events)
    found = read_run(journal, run)
    file = behavior or _recorded_file(found)
    catalogue = _known_states(file, named=behavior is not None)
    cell_spec = _read_cell(cell, found)
    plan = read_plan(file, catalogue, cell=cell_spec, substitutes=found.substitutes)
    require_simulation(plan, cell_spec, allowed=substitute_on_robots)
    options = OperatorOptions(
        autonomy=autonomy,
        operator=operator,
        loss=operator_loss,
        demand=demand_operator or found.origin.demand_operator,
        breakpoints=breakpoints,
        paused=paused,
    )
    decide = partial(
        plan_resume,
        found,
        plan,
        catalogue=catalogue,
        demanded=demand_operator,
        changed=changed,
        take_over=take_over,
    )
    answers = _read_answers(answer or [])
    try:
        resumption = decide(answers=answers)
    except ResumeDecisionRequired as questions:
        answers = {**answers, **_ask(questions)}
        resumption = decide(answers=answers)
    if not quiet and not json:
        _print_resumption(resumption)
    supervision = options.supervision(file, autonomy=resumption.autonomy)
    virtual = (clock or found.origin.clock) == "virtual"
    setup = RunSetup(
        opened=CellSetup(
            cell=cell_spec,
            seed=found.origin.seed,
            store=found.origin.store,
            relay=new_relay(cell_spec, virtual=virtual),
            journal=journal if journal != NO_JOURNAL else None,
        ),
        start=partial(CellRunner.resume, resumption=resumption, supervision=supervision),
        timeout_s=timeout,
        virtual=virtual,
        quiet=quiet or json,
        supervision=supervision,
        reload=partial(reload_plan, file, catalogue, cell=cell_spec, substitutes=found.substitutes)
        if operator
        else None,
    )

    def report(ended: ExecutionResult) -> None:
        report_run(ended.result, ended.log, ended.measures, as_json=json, events=events)

    raise typer.Exit(execute_run(setup, report=report))


def _recorded_file(found: RecordedRun) -> Path:
    """Return the behavior file that the journal names; a journal must not decide that Python code runs."""
    file = found.origin.behavior
    if is_python_name(file):
        hint = f"if you trust the file, give --behavior {file}"
        raise ControlError(
            "the behavior of the run is a Python file, which is executed when it is read", where=found.id, hint=hint
        )
    return Path(file)


def _known_states(file: Path, *, named: bool) -> StateCatalogue:
    """Load the states of the behavior's project if the user named the file or works in its folder; else those here."""
    here = Path.cwd()
    catalogue = load_states(file if named or file.resolve().is_relative_to(here) else here)
    if not is_python_name(str(file)):
        return catalogue
    return catalogue.including(load_python_behavior(str(file)).classes)


def _read_cell(file: Path | None, found: RecordedRun) -> Cell | None:
    path = file or (Path(found.origin.cell) if found.origin.cell is not None else None)
    # A run that was simulated must not go on with real arms.
    cell = with_simulated_devices(load_cell(path), found.origin.simulated) if path is not None else None
    require_no_new_real_devices(found, cell)
    return cell


def _read_answers(given: Sequence[str]) -> dict[str, str]:
    answers: dict[str, str] = {}
    for pair in given:
        path, equals, answer = pair.partition("=")
        if not (path and equals and answer):
            raise ControlError(f"{pair!r} is not PATH=rerun or PATH=OUTCOME", where="--answer")
        answers[path] = answer
    return answers


def _ask(questions: ResumeDecisionRequired) -> dict[str, str]:
    """Return the answers given at the terminal; without a terminal, print the questions and end the command."""
    if not (sys.stdin is not None and sys.stdin.isatty() and sys.stderr.isatty()):
        for question in questions.questions:
            choices = ", ".join((RERUN, *question.outcomes))
            sys.stderr.write(f"{question.path}: was active, how to resume? --answer {question.path}=… ({choices})\n")
        raise typer.Exit(ExitCode.BAD_INPUT)
    answers: dict[str, str] = {}
    for question in questions.questions:
        choices = (RERUN, *question.outcomes)
        answer = ""
        while answer not in choices:
            answer = typer.prompt(f"{question.path} was active: {', '.join(choices)}?", err=True).strip()
        answers[question.path] = answer
    return answers


def _print_resumption(resumption: ResumePlan) -> None:
    found, checkpoint = resumption.found, resumption.checkpoint
    for change in resumption.changes:
        sys.stderr.write(f"changed: {change}\n")
    if checkpoint is None:
        sys.stderr.write(f"{found.id} starts from the beginning: no event of it is durable\n")
        return
    where = f"resumes after event {checkpoint.read_seq}"
    if found.origin.cell is not None:
        where += ", the simulated world is restored" if resumption.restores else ", the cell is not restored"
    sys.stderr.write(f"{found.id} {where}\n")
    for path in checkpoint.rerun:
        sys.stderr.write(f"  rerun: {path}\n")
    for path, outcome in checkpoint.taken.items():
        sys.stderr.write(f"  outcome {outcome}: {path}\n")
