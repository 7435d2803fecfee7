"""`flexcell resume`: goes on with a run whose engine died, from its last durable event."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Literal

import typer

from engine.authoring.python_file import load_python_behavior
from engine.cell.open_cell import OpenCell
from engine.cli.exit_code import ExitCode
from engine.cli.inputs import read_plan, reload_plan
from engine.cli.operator_options import Autonomy, Breakpoints, Demand, Loss, Operator, OperatorOptions, Paused
from engine.cli.output_file import prepare, write
from engine.cli.run_execution import ExecutionResult, RunSetup, execute_run
from engine.cli.run_report import print_json, print_result
from engine.document.cell import Cell, load_cell
from engine.document.python_name import is_python_name
from engine.document.state_catalogue import StateCatalogue
from engine.errors import ControlError
from engine.host.state_folder_names import STATE_FOLDER
from engine.journal import Journal, NullJournal, encode_event_log
from engine.project.run_factory import ResumePlan, plan_resume, require_simulation, resume_run
from engine.recording.recorded_run import RecordedRun, read_run
from engine.registry import load_states
from engine.runtime.history.resume import RERUN, ResumeDecisionRequired
from engine.runtime.plan import Catalogue
from engine.runtime.record.skill_port import SkillPort
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions


def resume(
    run: Annotated[str, typer.Argument(help="The run, as `flexcell runs` names it.", show_default=False)],
    journal: Annotated[str, typer.Option(help="Directory of the journal of runs.")] = STATE_FOLDER,
    answer: Annotated[
        list[str] | None,
        typer.Option(help="PATH=rerun or PATH=OUTCOME, for a state that was in mid-work; may be repeated."),
    ] = None,
    changed: Annotated[
        bool, typer.Option("--changed", help="Go on in the behavior as its file is now, where that is possible.")
    ] = False,
    behavior: Annotated[
        Path | None, typer.Option(help="The behavior, where its file is no longer where it was.")
    ] = None,
    cell: Annotated[Path | None, typer.Option(help="The cell, where its file is no longer where it was.")] = None,
    clock: Annotated[
        Literal["virtual", "real"] | None, typer.Option(help="As the run was started, by default.")
    ] = None,
    take_over: Annotated[
        bool, typer.Option("--take-over", help="Also when a process drives it: that one can write no more and stops.")
    ] = False,
    events: Annotated[Path | None, typer.Option(help="Write the new events here, one JSON object a line.")] = None,
    timeout: Annotated[float | None, typer.Option(help="Stop the run after this many seconds.", min=0.001)] = None,
    substitute_on_robots: Annotated[
        bool, typer.Option("--substitute-on-robots", help="Where a run has substitutes: also where a robot is real.")
    ] = False,
    operator: Operator = False,
    autonomy: Autonomy = None,
    operator_loss: Loss = "hold",
    demand_operator: Demand = False,
    breakpoints: Breakpoints = False,
    paused: Paused = False,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout, nothing else.")] = False,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="Show no progress.")] = False,
) -> None:
    """Go on with an interrupted run.

    What had ended is not done again. A state in mid-work follows its `resume` policy; one that asks
    is asked for on the terminal, or must be answered with --answer. Exit codes are those of `run`.
    """
    prepare(events)
    found = read_run(journal, run)
    file = behavior or _recorded_file(found)
    catalogue = _known_states(file, named=behavior is not None)
    place = _read_cell(cell, found)
    plan = read_plan(file, catalogue, cell=place, substitutes=found.substitutes)
    require_simulation(plan, place, allowed=substitute_on_robots)
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
        answers = {**answers, **_asked(questions)}
        resumption = decide(answers=answers)
    if not quiet and not json:
        _tell(resumption)
    supervision = options.supervision(file, autonomy=resumption.autonomy)
    order = RunSetup(
        make=partial(_make, resumption, catalogue, answers, supervision),
        cell=place,
        seed=found.origin.seed,
        journal=journal,
        store=found.origin.store,
        timeout_s=timeout,
        virtual=(clock or found.origin.clock) == "virtual",
        quiet=quiet or json,
        supervision=supervision,
        reload=partial(reload_plan, file, catalogue, cell=place, substitutes=found.substitutes) if operator else None,
    )

    def report(ended: ExecutionResult) -> None:
        encoded = encode_event_log(ended.log)
        if json:
            print_json(ended.result, encoded, len(ended.log))
        else:
            print_result(ended.result)
        if events is not None:
            write(events, encoded)

    raise typer.Exit(execute_run(order, report=report))


async def _make(
    resumption: ResumePlan,
    catalogue: Catalogue,
    answers: Mapping[str, str],
    supervision: RunOptions,
    cell: OpenCell,
    journal: Journal | NullJournal,
    skills: SkillPort | None,
) -> Run:
    if isinstance(journal, NullJournal):
        raise ControlError("a run is resumed in its journal", where=resumption.found.id, hint="give --journal DIR")
    return await resume_run(
        resumption,
        cell=cell,
        journal=journal,
        catalogue=catalogue,
        answers=answers,
        supervision=supervision,
        skills=skills,
    )


def _recorded_file(found: RecordedRun) -> Path:
    """Return the behavior file that the journal names; Python is not run because a journal says so."""
    file = found.origin.behavior
    if is_python_name(file):
        hint = f"say that you want it with --behavior {file}"
        raise ControlError("the run was made by a Python file, which runs when it is read", where=found.id, hint=hint)
    return Path(file)


def _known_states(file: Path, *, named: bool) -> StateCatalogue:
    """Load the states of the behavior's project, if the user named the file or works in its folder; else those here."""
    here = Path.cwd()
    catalogue = load_states(file if named or file.resolve().is_relative_to(here) else here)
    if not is_python_name(str(file)):
        return catalogue
    return catalogue.including(load_python_behavior(str(file)).classes)


def _read_cell(file: Path | None, found: RecordedRun) -> Cell | None:
    path = file or (Path(found.origin.cell) if found.origin.cell is not None else None)
    return load_cell(path) if path is not None else None


def _read_answers(given: Sequence[str]) -> dict[str, str]:
    answers: dict[str, str] = {}
    for pair in given:
        path, equals, answer = pair.partition("=")
        if not (path and equals and answer):
            raise ControlError(f"{pair!r} is not PATH=rerun or PATH=OUTCOME", where="--answer")
        answers[path] = answer
    return answers


def _asked(questions: ResumeDecisionRequired) -> dict[str, str]:
    """Return what the person at the terminal says; without a terminal print the questions and end."""
    if not (sys.stdin is not None and sys.stdin.isatty() and sys.stderr.isatty()):
        for question in questions.questions:
            ways = ", ".join((RERUN, *question.outcomes))
            sys.stderr.write(f"{question.path}: what became of it? --answer {question.path}=… ({ways})\n")
        raise typer.Exit(ExitCode.BAD_INPUT)
    answers: dict[str, str] = {}
    for question in questions.questions:
        ways = (RERUN, *question.outcomes)
        said = ""
        while said not in ways:
            said = typer.prompt(f"{question.path} was in mid-work: {', '.join(ways)}?", err=True).strip()
        answers[question.path] = said
    return answers


def _tell(resumption: ResumePlan) -> None:
    found, checkpoint = resumption.found, resumption.checkpoint
    for change in resumption.changes:
        sys.stderr.write(f"changed: {change}\n")
    if checkpoint is None:
        sys.stderr.write(f"{found.id} begins anew: nothing of it had become durable\n")
        return
    where = f"goes on after event {checkpoint.read_seq}"
    if found.origin.cell is not None:
        where += ", the world brought to where it was" if resumption.restores else ", the cell as it is"
    sys.stderr.write(f"{found.id} {where}\n")
    for path in checkpoint.rerun:
        sys.stderr.write(f"  again: {path}\n")
    for path, outcome in checkpoint.taken.items():
        sys.stderr.write(f"  taken as {outcome}: {path}\n")
