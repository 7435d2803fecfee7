"""One crash trial: a process runs a behavior and is killed, others resume it, and the end is compared.

Every engine is a process of its own, forked from one that has everything imported.
"""

from __future__ import annotations

import os
import signal
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import msgspec

from benchmarks.crash_point import Counter, CrashingJournal, CrashPoint, Moment
from benchmarks.crash_subjects import Subject
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import Cell
from engine.event import Event, NodeEntered, NodeExited
from engine.journal import Journal, list_runs
from engine.project.cell_runner import CellRunner
from engine.project.resume_plan import ResumePlan, plan_resume
from engine.project.run_request import RunRequest
from engine.recording.recorded_run import RecordedRun, read_run
from engine.runtime.history.resume import ResumeDecisionRequired
from engine.runtime.plan import new_plan
from engine.runtime.run_options import RunOptions
from engine.runtime.run_result import RunResult

SEED = 3


class End(msgspec.Struct, frozen=True, kw_only=True):
    """How the last engine of a run left it."""

    status: str
    outcome: str | None
    userdata: dict[str, object]
    cause: str
    counts: dict[str, int]
    """What this engine did: events and commits."""


class Trial(msgspec.Struct, frozen=True, kw_only=True):
    """What became of one crash; `problems` is empty when nothing was lost and nothing done that must not be."""

    moment: str
    number: int
    engines: int
    durable: int
    """The events that were on the disk when the first engine died."""
    effects: tuple[str, ...]
    problems: tuple[str, ...]


def whole(subject: Subject, folder: Path) -> tuple[End, tuple[str, ...]]:
    """Run a subject without a crash; returns its end and its effects."""
    folder.mkdir(parents=True)
    if not _engine(lambda: _begin(subject, folder, None)):
        raise RuntimeError(f"{subject.name} does not run")
    return _end(folder), _effects(folder)


def crash(subject: Subject, folder: Path, point: CrashPoint, due: End, *, again: Sequence[CrashPoint] = ()) -> Trial:
    """Kill a run at a point and resume it until it ends; `again` kills the first engines that resume it."""
    folder.mkdir(parents=True)
    problems: list[str] = []
    ended = _engine(lambda: _begin(subject, folder, point))
    if ended:
        problems.append("it was not killed")
    known = _durable(folder)
    engines = 1
    while not ended:
        before = _durable(folder)
        next_point = again[engines - 1] if engines <= len(again) else None
        ended = _engine(partial(_go_on, subject, folder, next_point))
        engines += 1
        problems += _lost(before, _durable(folder))
    end = _end(folder)
    if (end.status, end.outcome, end.userdata) != (due.status, due.outcome, due.userdata):
        problems.append(f"ended {end.status} {end.outcome} {end.userdata} {end.cause}")
    effects = _effects(folder)
    problems += [f"{what} happened again" for what in subject.once if effects.count(what) > 1]
    problems += [f"{what} never happened" for what in subject.exactly if what not in effects]
    problems += _repeated(folder)
    return Trial(
        moment=point.moment,
        number=point.number,
        engines=engines,
        durable=len(known),
        effects=effects,
        problems=tuple(problems),
    )


def _engine(work: Callable[[], None]) -> bool:
    """Do `work` in a process of its own; False when it was killed."""
    pid = os.fork()
    if pid == 0:
        try:
            work()
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(70)
        os._exit(0)
    _, status = os.waitpid(pid, 0)
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGKILL:
        return False
    if os.waitstatus_to_exitcode(status) != 0:
        raise RuntimeError(f"an engine failed with {os.waitstatus_to_exitcode(status)}")
    return True


def _begin(subject: Subject, folder: Path, point: CrashPoint | None) -> None:
    plan = new_plan(subject.behavior(), subject.catalogue())
    counter = Counter(point)

    async def main() -> RunResult:
        with Journal.open(folder, inline=True) as journal:
            async with _cell(subject.cell(), folder) as cell:
                subject.install(cell.bus, folder / "effects")
                runner = CellRunner(cell, CrashingJournal(journal, counter))
                prepared = await runner.start(RunRequest(plan=plan, seed=SEED))
                subject.operate(prepared.run, ())
                return await prepared.execute()

    _write_end(folder, run_virtual(main()), counter)


def _go_on(subject: Subject, folder: Path, point: CrashPoint | None) -> None:
    catalogue = subject.catalogue()
    plan = new_plan(subject.behavior(), catalogue)
    found = read_run(folder, list_runs(folder)[0].id)
    counter = Counter(point)
    answers: dict[str, str] = {}

    def decide() -> ResumePlan:
        return plan_resume(found, plan, catalogue=catalogue, answers=answers)

    try:
        resumption = decide()
    except ResumeDecisionRequired as questions:
        effects = _effects(folder)
        answers |= {each.path: subject.answer(each, effects) for each in questions.questions}
        resumption = decide()

    async def main() -> RunResult:
        with Journal.open(folder, inline=True) as journal:
            async with _cell(subject.cell(), folder) as cell:
                subject.install(cell.bus, folder / "effects")
                runner = CellRunner(cell, CrashingJournal(journal, counter))
                prepared = await runner.resume(resumption, supervision=RunOptions())
                subject.operate(prepared.run, found.effective)
                return await prepared.execute()

    _write_end(folder, run_virtual(main()), counter)


def _cell(document: Cell | None, folder: Path) -> OpenCell:
    return OpenCell(document, seed=SEED, store_path=str(folder / "store.db"))


def _write_end(folder: Path, result: RunResult, counter: Counter) -> None:
    counts: Mapping[Moment, int] = counter.counts
    end = End(
        status=result.status,
        outcome=result.outcome,
        userdata=msgspec.to_builtins(dict(result.userdata)),
        cause="; ".join(link.message for link in result.cause.chain()) if result.cause is not None else "",
        counts={str(moment): count for moment, count in counts.items()},
    )
    (folder / "end.json").write_bytes(msgspec.json.encode(end))


def _end(folder: Path) -> End:
    return msgspec.json.decode((folder / "end.json").read_bytes(), type=End)


def _effects(folder: Path) -> tuple[str, ...]:
    file = folder / "effects"
    return tuple(file.read_text(encoding="utf-8").splitlines()) if file.exists() else ()


def _run(folder: Path) -> RecordedRun:
    return read_run(folder, list_runs(folder)[0].id)


def _durable(folder: Path) -> tuple[Event, ...]:
    return _run(folder).events if list_runs(folder) else ()


def _lost(before: tuple[Event, ...], after: tuple[Event, ...]) -> list[str]:
    return [] if after[: len(before)] == before else ["events that were durable have gone"]


def _repeated(folder: Path) -> list[str]:
    """Return the activations that had ended durably and were begun again; numbers of events must have no gap."""
    found = _run(folder)
    finished: set[tuple[str, int]] = set()
    problems: list[str] = []
    for event in found.effective:
        key: Any = (event.path, event.visit) if isinstance(event, NodeEntered | NodeExited) else None
        if isinstance(event, NodeExited) and not event.preempted:
            finished.add(key)
        elif isinstance(event, NodeEntered) and key in finished:
            problems.append(f"{event.path} was entered again as visit {event.visit}")
    if [event.seq for event in found.events] != list(range(1, len(found.events) + 1)):
        problems.append("the events are not numbered without gaps")
    return problems
