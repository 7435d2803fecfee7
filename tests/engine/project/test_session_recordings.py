"""A session records its runs beside their journal: bounded, never in the way of a run, replayable."""

from __future__ import annotations

import asyncio
import errno
import os
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import msgspec
import pytest

from engine.cell.open_cell import OpenCell
from engine.errors import RecordingError
from engine.journal import Journal
from engine.messages import JointState
from engine.messages.sensing import OccupancyGrid
from engine.project.session import Session
from engine.project.session_recordings import SessionRecordings
from engine.recording import load_recording
from engine.recording.file_content import lock_against_removal
from engine.recording.indexed_recording import IndexedRecording
from engine.recording.live_file import LiveFile
from tests.engine.fake_states import CATALOGUE

BEHAVIOR = """
flexcell: 1
name: {name}
parameters: {{pause: {{type: number, default: 0.01, minimum: 0, maximum: 100}}}}
outcomes: [good]
success: [good]
root:
  machine:
    initial: wait
    states:
      wait: {{state: {state}, transitions: {{{outcome}: good}}}}
"""
QUICK, ENDLESS = "behaviors/quick.yaml", "behaviors/endless.yaml"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with a quick behavior and an endless one."""
    folder = tmp_path / "behaviors"
    folder.mkdir()
    quick = BEHAVIOR.format(name="quick", state='test.Give, with: {after_s: "${pause}"}', outcome="a: good, b: good, c")
    (folder / "quick.yaml").write_text(quick, encoding="utf-8")
    endless = BEHAVIOR.format(name="endless", state="test.Use, with: {for_s: 1000}", outcome="done")
    (folder / "endless.yaml").write_text(endless, encoding="utf-8")
    return tmp_path


@asynccontextmanager
async def _session(project: Path, recordings: SessionRecordings) -> AsyncGenerator[Session]:
    with Journal.open(project / "journal") as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=project, catalogue=CATALOGUE, journal=journal, recordings=recordings) as opened,
        ):
            yield opened


async def _quick(session: Session) -> str:
    run = await session.start(QUICK, parameters={}, seed=1)
    await session.wait(run)
    return run


async def _endless(session: Session) -> str:
    """Start a run that does not end, and wait until it has begun."""
    begun = asyncio.Event()
    unsubscribe = session.subscribe(lambda live, change: begun.set())
    run = await session.start(ENDLESS, parameters={}, seed=1)
    await begun.wait()
    unsubscribe()
    return run


def _events_in(path: Path) -> int:
    try:
        return len(load_recording(path).events)
    except RecordingError:
        return 0  # its head is still being written


def _joints(time_s: float) -> JointState:
    return JointState(time_s=time_s, names=("a",), position_rad=(time_s,), velocity_rad_s=(0.0,), effort_nm=(0.0,))


async def test_every_run_has_a_recording_that_can_be_replayed(project: Path) -> None:
    recordings = SessionRecordings(project / "recordings")
    async with _session(project, recordings) as session:
        runs = [await _quick(session), await _quick(session)]
        await recordings.finished()
        events = {run: session.events(run) for run in runs}
        files = {run: session.recording_files(run) for run in runs}
    for run in runs:
        (file,) = files[run]
        assert file == project / "recordings" / f"{run}.mcap"
        assert [each.event for each in load_recording(file).events] == events[run]


async def test_a_recording_has_the_start_of_a_run_that_is_looked_at_at_once(project: Path) -> None:
    """As a page does that has just started it; the first look makes the run record its start."""
    recordings = SessionRecordings(project / "recordings")
    async with _session(project, recordings) as session:
        run = await session.start(QUICK, parameters={}, seed=1)
        assert session.run(run).status == "running"
        await session.wait(run)
        await recordings.finished()
        (file,) = session.recording_files(run)
        assert [each.event for each in load_recording(file).events] == session.events(run)


async def test_a_run_under_way_has_one_too_and_a_killed_server_leaves_it_readable(project: Path) -> None:
    recordings = SessionRecordings(project / "recordings")
    async with _session(project, recordings) as session:
        run = await _endless(session)
        (file,) = session.recording_files(run)
        assert file.name == f"{run}.mcap.part"
        while not await asyncio.to_thread(_events_in, project / "recordings" / f"{run}.mcap"):
            pass  # the disk is written by a thread of its own


async def test_a_file_that_is_gone_when_it_is_looked_at_costs_no_recording(project: Path) -> None:
    """As that of the run before is, which gets its name just then."""
    (project / "recordings").mkdir()
    (project / "recordings" / "before.mcap.part").symlink_to(project / "nowhere")
    recordings = SessionRecordings(project / "recordings")
    async with _session(project, recordings) as session:
        run = await _quick(session)
        await recordings.finished()
        assert [file.name for file in session.recording_files(run)] == [f"{run}.mcap"]


async def test_only_so_many_are_kept_and_the_oldest_go_first(project: Path) -> None:
    recordings = SessionRecordings(project / "recordings", kept=2)
    async with _session(project, recordings) as session:
        endless = await _endless(session)
        quick: list[str] = []
        for age_s in (300, 200, 100):
            quick.append(await _quick(session))
            await recordings.finished()
            for file in session.recording_files(quick[-1]):
                at_s = file.stat().st_mtime - age_s
                os.utime(file, (at_s, at_s))
        # The one under way is the oldest of all, and in use.
        os.utime(session.recording_files(endless)[0], (0, 0))
        assert [bool(session.recording_files(run)) for run in (endless, *quick)] == [True, False, False, True]


async def test_all_together_are_no_larger_than_allowed_and_one_that_is_read_stays(project: Path) -> None:
    folder = project / "recordings"
    folder.mkdir()
    for age, name in enumerate(("new", "read", "old")):
        (folder / f"{name}.mcap").write_bytes(bytes(600_000))
        os.utime(folder / f"{name}.mcap", (1e9 - age, 1e9 - age))
    recordings = SessionRecordings(folder, size_mb=1.5)
    with (folder / "read.mcap").open("rb") as stream:
        lock_against_removal(stream)
        async with _session(project, recordings) as session:
            await _quick(session)
            await recordings.finished()
    assert [(folder / f"{name}.mcap").exists() for name in ("new", "read", "old")] == [True, True, False]


async def test_a_full_disk_ends_the_recording_and_not_the_run(
    project: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(LiveFile, "open", full)
    recordings = SessionRecordings(project / "recordings")
    async with _session(project, recordings) as session:
        run = await _quick(session)
        assert session.run(run).success
        assert session.recording_files(run) == ()
    assert "No space left" in caplog.text


async def test_a_folder_that_cannot_be_made_is_a_warning(project: Path, caplog: pytest.LogCaptureFixture) -> None:
    (project / "recordings").write_text("in the way", encoding="utf-8")
    async with _session(project, SessionRecordings(project / "recordings")) as session:
        assert session.run(await _quick(session)).success
    assert "is not recorded" in caplog.text


async def test_what_costs_much_is_recorded_only_while_somebody_looks(project: Path) -> None:
    grid = OccupancyGrid(
        time_s=0.0, revision=1, corner_m=(0.0, 0.0, 0.0), voxel_m=0.1, shape=(1, 1, 1), occupied=b"\x80"
    )
    recordings = SessionRecordings(project / "recordings")
    async with _session(project, recordings) as session:
        bus = session.cell.bus
        voxels, joints = bus.topic("cell/occupancy", OccupancyGrid), bus.topic("arm/joint_state", JointState)
        run = await _endless(session)
        assert (voxels.subscriber_count, joints.subscriber_count) == (0, 1)
        voxels.publish(grid)
        joints.publish(_joints(1.0))
    (file,) = recordings.files(run)
    with IndexedRecording.open(file) as moments:
        found = [moments.at(topic, 1e6) for topic in ("cell/occupancy", "arm/joint_state")]
    # Nobody looked at the voxels: they were published all the same, and so they are there.
    grids, states = (each.data if each is not None else b"" for each in found)
    assert msgspec.json.decode(grids, type=OccupancyGrid) == grid
    assert msgspec.json.decode(states, type=JointState) == _joints(1.0)


@pytest.mark.parametrize("name", ["../journal", "a/b", "", "*", "x" * 200])
def test_a_name_that_is_no_run_has_no_recording(project: Path, name: str) -> None:
    assert SessionRecordings(project).files(name) == ()
