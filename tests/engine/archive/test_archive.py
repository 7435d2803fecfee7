"""What is left of runs is listed with how it ended, and opened with the behavior as it was then."""

from __future__ import annotations

import asyncio
import shutil
from pathlib import Path

import pytest

from engine.archive import Archive, PastRun
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.errors import JournalError, RecordingError
from engine.event import RunEnded
from engine.journal import Journal
from engine.project.session import Session
from engine.project.session_recordings import SessionRecordings
from engine.recording import load_recording
from tests.engine.fake_states import CATALOGUE

HEAD = "flexcell: 1\noutcomes: [good, bad]\nsuccess: [good]\n"
GOES_WELL = f"""{HEAD}name: goes well
root:
  machine:
    initial: one
    states:
      one: {{state: test.Give, transitions: {{a: good, b: bad, c: bad}}}}
"""
GOES_WRONG = f"""{HEAD}name: goes wrong
root:
  machine:
    initial: one
    states:
      one: {{state: test.Raise, transitions: {{done: good}}}}
"""


def made(folder: Path) -> Path:
    """Make a project with three runs, each recorded; the last one was stopped."""
    (folder / "behaviors").mkdir()
    texts = {
        "well": GOES_WELL,
        "wrong": GOES_WRONG,
        "long": GOES_WELL.replace("test.Give", "test.Give, with: {after_s: 9}"),
    }
    for name, text in texts.items():
        (folder / f"behaviors/{name}.yaml").write_text(
            text.replace("goes well", "goes long") if name == "long" else text
        )
    run_virtual(_runs(folder))
    return folder


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Such a project, which nobody changes."""
    return made(tmp_path_factory.mktemp("project"))


@pytest.fixture
def project(recorded: Path, tmp_path: Path) -> Path:
    """A copy of it that the test may change."""
    return Path(shutil.copytree(recorded, tmp_path / "project"))


async def _runs(folder: Path) -> None:
    recordings = SessionRecordings(folder / ".flexcell" / "recordings")
    with Journal.open(folder / ".flexcell", inline=True) as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=folder, catalogue=CATALOGUE, journal=journal, recordings=recordings) as session,
        ):
            for name in ("well", "wrong", "long"):
                run = await session.start(f"behaviors/{name}.yaml", parameters={}, seed=1)
                if name == "long":
                    await asyncio.sleep(1)
                    await session.stop(run, reason="enough")
                await session.wait(run)
            await recordings.finished()


@pytest.fixture
def archive(project: Path) -> Archive:
    """Opened afresh, as after a restart."""
    return Archive(project, CATALOGUE, project / ".flexcell")


def run_of(archive: Archive, behavior: str) -> PastRun:
    """The one run of a behavior."""
    return next(run for run in archive.runs() if run.behavior == behavior)


def test_runs_are_listed_with_how_they_ended(archive: Archive) -> None:
    """With why: what was stopped is no failure."""
    told = {run.behavior: (run.status, run.outcome, run.success, run.failed, bool(run.cause)) for run in archive.runs()}
    assert told == {
        "goes well": ("finished", "good", True, False, False),
        "goes wrong": ("errored", None, False, True, True),
        "goes long": ("stopped", None, False, False, True),
    }


def test_a_run_is_opened_with_the_behavior_as_it_was(tmp_path: Path) -> None:
    """Though its file says something else by now."""
    project = made(tmp_path)
    archive = Archive(project, CATALOGUE, project / ".flexcell")
    run = run_of(archive, "goes well")
    file = project / "behaviors/well.yaml"
    file.write_text(GOES_WRONG)
    opened = archive.run(run.id)
    assert opened.behavior.id == "behaviors/well.yaml"
    assert opened.behavior.name == "goes well"
    assert opened.behavior.graph is not None
    assert [child.title for child in opened.behavior.graph.children] == ["test.Give"]
    assert isinstance(opened.events[-1], RunEnded)
    assert opened.events[-1].seq == run.events


def test_a_recording_tells_the_same_as_the_journal(archive: Archive) -> None:
    """Its summary, its events and its behavior."""
    for run in archive.runs():
        path = archive.recording_of(run.id)
        assert path == f".flexcell/recordings/{run.id}.mcap"
        opened, journaled = archive.recording(path), archive.run(run.id)
        assert opened.events == journaled.events
        assert (opened.summary.status, opened.summary.failed) == (run.status, run.failed)
        assert opened.behavior.graph == journaled.behavior.graph


def test_recordings_are_found_and_garbage_is_named(archive: Archive, project: Path) -> None:
    """What cannot be opened says why; what is no recording by its name is left out."""
    (project / "sub").mkdir()
    (project / "sub" / "garbage.mcap").write_bytes(b"\x00" * 300)
    (project / "sub" / "notes.txt").write_text("no recording")
    (project / "node_modules").mkdir()
    (project / "node_modules" / "not_ours.mcap").write_bytes(b"")
    files = {file.path: file for file in archive.recordings()}
    good = [file for file in files.values() if not file.problem]
    assert {file.run for file in good} == {run.id for run in archive.runs()}
    assert files["sub/garbage.mcap"].problem == "this is not an MCAP file"
    assert not any("node_modules" in path or path.endswith(".txt") for path in files)
    with pytest.raises(RecordingError, match="not an MCAP file"):
        archive.recording("sub/garbage.mcap")


@pytest.mark.parametrize(
    "name",
    [
        "../outside.mcap",
        "/etc/outside.mcap",
        "sub/../../outside.mcap",
        "link.mcap",
        "nothing.mcap",
        "a\0.mcap",
        "behaviors",
        "",
    ],
)
def test_nothing_outside_of_the_project_is_opened(archive: Archive, project: Path, name: str) -> None:
    """Not by dots, not absolutely, not through a link."""
    outside = project.parent / "outside.mcap"
    source = next((project / ".flexcell/recordings").glob("*.mcap"))
    outside.write_bytes(source.read_bytes())
    assert load_recording(outside).complete
    (project / "link.mcap").symlink_to(outside)
    assert "link.mcap" not in {file.path for file in archive.recordings()}
    with pytest.raises(RecordingError, match="no such recording"):
        archive.recording(name)


def test_without_a_journal_there_are_no_runs(tmp_path: Path) -> None:
    """And asking for one says so."""
    archive = Archive(tmp_path, {}, tmp_path / "nowhere")
    assert archive.runs() == ()
    assert archive.recordings() == ()
    with pytest.raises(JournalError, match="there is no run 'x'"):
        archive.run("x")
