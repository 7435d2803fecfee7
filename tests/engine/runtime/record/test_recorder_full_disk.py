"""A run whose events cannot be kept has failed with that cause, whether or not it commands anything."""

from __future__ import annotations

import resource
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import pytest

from engine.cause_chain import describe_cause
from engine.cell.open_cell import OpenCell
from engine.errors import JournalError
from engine.event import Event, RunEnded
from engine.journal import Journal, list_runs, read_events
from engine.project.session import Session
from tests.engine.fake_states import CATALOGUE

WAIT = """
flexcell: 1
name: wait
parameters: {for_s: {type: number, default: 0, minimum: 0, maximum: 1000}}
outcomes: [good]
success: [good]
root:
  machine:
    initial: wait
    states:
      wait: {state: test.Give, with: {after_s: "${for_s}"}, transitions: {a: good, b: good, c: good}}
"""
BEHAVIOR = "behaviors/wait.yaml"
SAID = "journal.db: the journal cannot be written: "


@contextmanager
def full_disk(folder: Path) -> Generator[None]:
    """No file may grow beyond what the largest one here has."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    size = max(file.stat().st_size for file in folder.iterdir())
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "behaviors").mkdir()
    (tmp_path / BEHAVIOR).write_text(WAIT, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize(("inline", "for_s"), [(True, 0.0), (False, 3.0)])
async def test_it_ends_errored_and_the_next_runs_again_once_there_is_space(
    project: Path, inline: bool, for_s: float
) -> None:
    folder = project / "journal"
    told: list[Event] = []
    with Journal.open(folder, inline=inline) as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=project, catalogue=CATALOGUE, journal=journal) as session,
        ):
            session.subscribe(lambda run, _change: told.append(run.events[-1]))
            lost = await session.start(BEHAVIOR, parameters={"for_s": for_s}, seed=0)
            with full_disk(folder):
                view = await session.wait(lost)
                assert (view.status, view.outcome, view.success) == ("errored", None, False)
                assert SAID in view.cause
                assert "check free space" in view.cause
                ends = [event for event in told if isinstance(event, RunEnded)]
                assert [(end.status, end.cause is not None and SAID in describe_cause(end.cause)) for end in ends] == [
                    ("errored", True)
                ]
                assert session.events(lost)[-1] == ends[0]
                with pytest.raises(JournalError, match=SAID):
                    await session.start(BEHAVIOR, parameters={}, seed=0)
            again = await session.start(BEHAVIOR, parameters={}, seed=0)
            assert (await session.wait(again)).success
    assert {run.id: run.status for run in list_runs(folder)} == {lost: "running", again: "finished"}
    assert [type(event) for event in read_events(folder, again)][-1] is RunEnded
    assert all(not run.damage for run in list_runs(folder))


async def test_a_run_that_lost_nothing_goes_on(project: Path) -> None:
    """Only those whose events could not be written end."""
    folder = project / "journal"
    with Journal.open(folder, inline=True) as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=project, catalogue=CATALOGUE, journal=journal) as session,
        ):
            waiting = await session.start(BEHAVIOR, parameters={"for_s": 1000.0}, seed=0)
            kept = await session.start(BEHAVIOR, parameters={}, seed=0)
            assert (await session.wait(kept)).success
            lost = await session.start(BEHAVIOR, parameters={}, seed=0)
            with full_disk(folder):
                assert (await session.wait(lost)).status == "errored"
            assert session.run(waiting).status == "running"
            await session.stop(waiting, reason="enough")
            assert (await session.wait(waiting)).status == "stopped"
