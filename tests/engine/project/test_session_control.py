"""A session controls its runs, counts their operators, resumes interrupted ones and begins at chosen moments."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.archive import Archive, RunTrends, compare_runs
from engine.cell.open_cell import OpenCell
from engine.errors import ControlError, DocumentError, FlexcellError
from engine.event import Event, GateReached, NodeEntered, OperatorChanged, OperatorCommanded, UserdataWritten
from engine.journal import Journal
from engine.project.run_request import RunPosition
from engine.project.session import Session
from engine.registry import load_states
from engine.runtime.control import Breakpoint, save_breakpoints
from engine.runtime.history.resume import ResumeDecisionRequired
from engine.runtime.run_options import RunOptions
from tests.engine.cli.process import entered, run_id_in, started, until
from tests.engine.fake_states import CATALOGUE

STEPS = """
flexcell: 1
name: steps
parameters: {add: {type: integer, default: 10}}
userdata: {value: 0}
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: one
    states:
      one: {state: test.Write, with: {value: 1}, transitions: {done: two}}
      two: {state: test.Give, with: {outcome: a}, autonomy: {a: high}, transitions: {a: three, b: good, c: bad}}
      three: {state: test.Write, with: {value: "${value + add}"}, transitions: {done: good}}
"""
BEHAVIOR = "behaviors/steps.yaml"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with the one behavior."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / BEHAVIOR).write_text(STEPS, encoding="utf-8")
    return tmp_path


@asynccontextmanager
async def opened(project: Path, *, real_states: bool = False) -> AsyncGenerator[Session]:
    """A session without a cell."""
    catalogue = load_states() if real_states else CATALOGUE
    with Journal.open(project / ".flexcell", inline=True) as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=project, catalogue=catalogue, journal=journal) as session,
        ):
            yield session


async def recorded(session: Session, run: str, true: Callable[[Event], bool]) -> None:
    """Wait until a run has had such an event."""
    while not any(true(event) for event in session.events(run)):
        await session.cell.bus.clock.sleep(0)


def waits(path: str) -> Callable[[Event], bool]:
    """Tell whether a node waits at the gate."""
    return lambda event: isinstance(event, GateReached) and event.path == path


@pytest.mark.virtual
async def test_a_run_is_controlled_and_shown_with_its_control(project: Path) -> None:
    async with opened(project) as session:
        run = await session.start(BEHAVIOR, parameters={}, seed=0, supervision=RunOptions(start_paused=True))
        await recorded(session, run, waits("root"))
        view = session.control(run).view()
        assert session.run(run).waits == "paused"
        # The time of a paused run stands.
        assert session.run(run).duration_s == session.live(run).state.time_s
        assert (view.paused, view.confirmed, [each.path for each in view.waiting]) == (True, True, ["root"])
        session.control(run).resume()
        assert (await session.wait(run)).outcome == "good"
        assert session.run(run).waits == ""
        with pytest.raises(ControlError, match="this run is over"):
            session.control(run)
        with pytest.raises(FlexcellError, match="there is no run 'x'"):
            session.control("x")


@pytest.mark.virtual
async def test_a_run_has_an_operator_as_long_as_anybody_is_there(project: Path) -> None:
    """Only the last one who leaves, or is lost, counts; with nobody, the rules are off and the run goes on."""
    async with opened(project) as session:
        supervision = RunOptions(autonomy="low", start_paused=True)
        run = await session.start(BEHAVIOR, parameters={}, seed=0, supervision=supervision)
        first, second, third = session.operate(run), session.operate(run), session.operate(run)
        session.control(run).resume()
        await recorded(session, run, waits("root/two"))
        first.lose()
        second.detach()
        second.lose()
        assert session.control(run).view().operator == "attached"
        third.detach()
        assert (await session.wait(run)).outcome == "good"
        changes = [event.status for event in session.events(run) if isinstance(event, OperatorChanged)]
        assert changes == ["attached", "detached"]


@pytest.mark.virtual
async def test_a_lost_operator_has_the_run_held_after_a_while(project: Path) -> None:
    async with opened(project) as session:
        supervision = RunOptions(autonomy="low", loss_timeout_s=2.0)
        run = await session.start(BEHAVIOR, parameters={}, seed=0, supervision=supervision)
        attachment = session.operate(run)
        await recorded(session, run, waits("root/two"))
        attachment.lose()
        await session.cell.bus.clock.sleep(3.0)
        view = session.control(run).view()
        assert (view.operator, view.paused) == ("lost", True)
        session.operate(run)
        session.control(run).answer("root/two")
        session.control(run).resume()
        assert (await session.wait(run)).outcome == "good"


@pytest.mark.virtual
async def test_the_file_as_it_is_now_takes_over_a_paused_run(project: Path) -> None:
    async with opened(project) as session:
        run = await session.start(BEHAVIOR, parameters={}, seed=0, supervision=RunOptions(start_paused=True))
        (project / BEHAVIOR).write_text(STEPS.replace("value: 1}", "value: 5}"), encoding="utf-8")
        assert (await session.change(run)).changes == ("root/one has changed parameters",)
        (project / BEHAVIOR).write_text("root: [", encoding="utf-8")
        with pytest.raises(DocumentError):
            await session.change(run)
        session.control(run).resume()
        assert (await session.wait(run)).outcome == "good"


@pytest.mark.virtual
async def test_breakpoints_beside_the_file_are_used_when_asked_for(project: Path) -> None:
    save_breakpoints(project / BEHAVIOR, [Breakpoint(path="root/three")])
    async with opened(project) as session:
        free = await session.start(BEHAVIOR, parameters={}, seed=0)
        assert (await session.wait(free)).outcome == "good"
        run = await session.start(BEHAVIOR, parameters={}, seed=0, breakpoints=True)
        await recorded(session, run, waits("root/three"))


@pytest.mark.virtual
async def test_a_run_begins_at_a_moment_of_another(project: Path) -> None:
    async with opened(project) as session:
        before = await session.start(BEHAVIOR, parameters={"add": 3}, seed=0)
        await session.wait(before)
        seq = next(e.seq for e in session.events(before) if isinstance(e, NodeEntered) and e.path == "root/three")
        run = await session.start(BEHAVIOR, parameters={}, seed=0, begin=RunPosition(run=before, seq=seq))
        assert (await session.wait(run)).outcome == "good"
        paths = [event.path for event in session.events(run) if isinstance(event, NodeEntered)]
        assert paths == ["root", "root/three"]
        written = [event.value for event in session.events(run) if isinstance(event, UserdataWritten)]
        assert written == [1, 4]
        with pytest.raises(DocumentError, match="has no event 900"):
            await session.start(BEHAVIOR, parameters={}, seed=0, begin=RunPosition(run=before, seq=900))


@pytest.mark.virtual
async def test_a_run_starts_at_a_node_with_the_data_of_the_last_run_that_entered_it(project: Path) -> None:
    """Values that are given replace those of that run; without such a run it starts with the initial ones."""
    async with opened(project) as session:
        fresh = await session.start_data(BEHAVIOR, "root/three")
        assert (fresh.run, fresh.userdata, fresh.obstacle) == ("", {"value": 0}, "")
        alone = await session.start(BEHAVIOR, parameters={}, seed=0, begin=RunPosition(path="root/three"))
        assert (await session.wait(alone)).outcome == "good"
        before = await session.start(BEHAVIOR, parameters={"add": 3}, seed=0)
        await session.wait(before)
        found = await session.start_data(BEHAVIOR, "root/three")
        assert (found.run, found.parameters["add"], found.userdata) == (before, 3, {"value": 1})
        begin = RunPosition(run=found.run, seq=found.seq, path="root/three")
        run = await session.start(BEHAVIOR, parameters={}, seed=0, begin=begin, inputs={"value": 7})
        assert (await session.wait(run)).outcome == "good"
        paths = [event.path for event in session.events(run) if isinstance(event, NodeEntered)]
        assert paths == ["root", "root/three"]
        assert [event.value for event in session.events(run) if isinstance(event, UserdataWritten)] == [7, 10]
        assert "there is no such node" in (await session.start_data(BEHAVIOR, "root/nowhere")).obstacle


@pytest.mark.virtual
async def test_a_run_pauses_once_before_the_node_that_it_runs_to(project: Path) -> None:
    async with opened(project) as session:
        run = await session.start(BEHAVIOR, parameters={}, seed=0, until="root/three")
        await recorded(session, run, waits("root/three"))
        assert session.control(run).view().breakpoints == ()
        session.control(run).resume()
        assert (await session.wait(run)).outcome == "good"
        with pytest.raises(ControlError, match="no run enters this node"):
            await session.start(BEHAVIOR, parameters={}, seed=0, until="root/nowhere")


ASKS = """
flexcell: 1
name: asks
outcomes: [good]
success: [good]
root:
  machine:
    initial: first
    states:
      first: {state: flow.Wait, with: {duration_s: 0.01}, transitions: {done: second}}
      second: {state: flow.Wait, with: {duration_s: 3000}, resume: ask, transitions: {done: good}}
"""


async def test_a_run_whose_process_was_killed_is_resumed_in_a_session(project: Path) -> None:
    """Its events from before are there, the question is asked, the answer taken."""
    file = project / "behaviors" / "asks.yaml"
    file.write_text(ASKS, encoding="utf-8")
    with started("run", file, "-q", cwd=project) as process:
        known = until(process, project, entered("root/second"))
    run = run_id_in(project)
    async with opened(project, real_states=True) as session:
        (interrupted,) = session.interrupted()
        assert interrupted.id == run
        with pytest.raises(ResumeDecisionRequired):
            await session.resume(run)
        assert await session.resume(run, answers={"root/second": "done"}) == run
        view = await session.wait(run)
        assert (view.behavior, view.status, view.outcome) == ("behaviors/asks.yaml", "finished", "good")
        events = session.events(run)
        assert tuple(events[: len(known)]) == known
        assert [event.seq for event in events] == list(range(1, len(events) + 1))
        assert session.interrupted() == ()
        with pytest.raises(ControlError, match="this run is over"):
            await session.resume(run)
        # It has one start and one duration, wherever it is shown.
        archive = Archive(project, load_states(), project / ".flexcell")
        past, opened_again = archive.runs()[0], archive.run(run)
        trend = RunTrends(archive).of("asks", last=1)
        shown = (view, past, opened_again.summary, compare_runs(opened_again, opened_again).left, *trend.runs)
        assert [each.duration_s for each in shown] == [events[-1].time_s] * 5
        assert [each.started_at_s for each in shown] == [interrupted.started_unix_s] * 5
        assert events[-1].time_s > known[-1].time_s
    assert not [event for event in known if isinstance(event, OperatorCommanded)]


async def test_a_run_of_another_project_is_not_resumed(project: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    file = elsewhere / "asks.yaml"
    file.write_text(ASKS, encoding="utf-8")
    with started("run", file, "-q", "--journal", project / ".flexcell", cwd=project) as process:
        until(process, project, entered("root/second"))
    async with opened(project, real_states=True) as session:
        with pytest.raises(DocumentError, match="this behavior belongs to another project"):
            await session.resume(run_id_in(project))
