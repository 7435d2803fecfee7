"""A byte of a journal that is not what was written is found by every reader and told with file, run and event."""

from __future__ import annotations

import random
import sqlite3
from collections.abc import Callable
from pathlib import Path

import pytest

from engine.archive.past_runs import PastRuns
from engine.errors import JournalError
from engine.event import Logged, RunEnded
from engine.journal import Journal, RunOrigin, list_runs, read_events, read_origin, read_world
from tests.engine.journal.older_journal import write_older_journal

RUNS = ("first", "second")
EVENTS = 20


def said(seq: int) -> Logged:
    return Logged(seq=seq, time_s=seq * 0.5, path="root", level="info", message=f"step {seq} " + "x" * (seq * 7 % 150))


async def written(folder: Path) -> Path:
    """Write a journal of two runs, one of them over, and put all of it into the one file."""
    with Journal.open(folder, inline=True) as journal:
        for name in RUNS:
            origin = RunOrigin(behavior="/b.yaml", documents={"b.yaml": "text " * 100})
            run = journal.begin(name, behavior="transfer", document="abc", started_unix_s=10.0, origin=origin)
            for seq in range(1, EVENTS):
                run.append(said(seq))
                run.keep_world(bytes(range(100)))
                await run.commit()
            run.append(RunEnded(seq=EVENTS, time_s=30.0, status="finished", outcome="done"))
            await run.commit()
    return folder / "journal.db"


def everything(file: Path) -> object:
    """Read all that there is."""
    return (
        list_runs(file),
        PastRuns(file, success=lambda run, document: ("done",)).all(),
        [(read_events(file, run), read_origin(file, run), read_world(file, run)) for run in RUNS],
    )


def change(file: Path, statement: str) -> None:
    connection = sqlite3.connect(file, isolation_level=None)
    connection.executescript(statement)
    connection.close()


EVENT = r"journal\.db: event {} of run first is damaged"


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ("UPDATE event SET data = replace(data, 'step 7', 'step 8') WHERE run = 'first'", EVENT.format(7)),
        ("UPDATE event SET time_s = 3 WHERE run = 'first' AND seq = 7", EVENT.format(7)),
        ("UPDATE event SET epoch = 2 WHERE run = 'first' AND seq = 7", EVENT.format(7)),
        ("UPDATE event SET checksum = NULL WHERE run = 'first' AND seq = 7", EVENT.format(7)),
        ("DELETE FROM event WHERE run = 'first' AND seq = 7", EVENT.format(8)),
        ("DELETE FROM event WHERE run = 'first' AND seq = 1", EVENT.format(2)),
        (
            "UPDATE event SET seq = 99 WHERE run = 'first' AND seq = 7;"
            "UPDATE event SET seq = 7 WHERE run = 'first' AND seq = 8;"
            "UPDATE event SET seq = 8 WHERE run = 'first' AND seq = 99",
            EVENT.format(7),
        ),
        (
            "DELETE FROM event WHERE run = 'first' AND seq > 18",
            r"journal\.db: run first has 18 events in the journal, and 20 were written",
        ),
        (
            "UPDATE event SET run = 'second', seq = 21 WHERE run = 'first' AND seq = 20",
            r"run first has 19 events in the journal, and 20 were written",
        ),
        ("UPDATE checksum SET since = 5 WHERE run = 'first'", "says of run first as a whole is damaged"),
    ],
)  # fmt: skip
async def test_a_changed_event_is_told_with_file_run_and_number(tmp_path: Path, statement: str, said: str) -> None:
    file = await written(tmp_path)
    change(file, statement)
    with pytest.raises(JournalError, match=said):
        read_events(file, "first")


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE run SET status = 'running' WHERE id = 'first'",
        "UPDATE run SET behavior = 'another' WHERE id = 'first'",
        "UPDATE run SET started = 11 WHERE id = 'first'",
        "UPDATE run SET epoch = 2 WHERE id = 'first'",
        "UPDATE driver SET engine = 'x' WHERE run = 'first'",
        "DELETE FROM event WHERE run = 'first' AND seq = 20",
    ],
)
async def test_a_damaged_run_is_listed_as_such_and_hides_no_other(tmp_path: Path, statement: str) -> None:
    file = await written(tmp_path)
    change(file, statement)
    first, second = sorted(list_runs(file), key=lambda run: run.id)
    assert "first" in first.damage
    assert not first.interrupted
    assert (second.damage, second.verified) == ("", True)
    by_id = {run.id: run for run in PastRuns(file, success=lambda run, document: ("done",)).all()}
    assert (by_id["first"].status, by_id["first"].success) == ("errored", False)
    assert "first" in by_id["first"].cause
    assert by_id["second"].success
    with pytest.raises(JournalError, match="run first"):
        Journal.open(file).resume("first")


@pytest.mark.parametrize("table", ["run", "checksum"])
async def test_a_run_that_is_missing_is_missed(tmp_path: Path, table: str) -> None:
    file = await written(tmp_path)
    change(file, f"DELETE FROM {table} WHERE {'id' if table == 'run' else 'run'} = 'first'")
    with pytest.raises(JournalError, match="run 'first' is in one of its tables only"):
        list_runs(file)


@pytest.mark.parametrize(
    ("statement", "read", "said"),
    [
        ("UPDATE origin SET data = replace(data, 'text', 'test')", read_origin, "the origin of run first is damaged"),
        ("DELETE FROM origin", read_origin, "the origin of run first is damaged"),
        ("UPDATE world SET data = x'00'", read_world, "the simulated world of run first is damaged"),
        ("UPDATE world SET seq = 3", read_world, "the simulated world of run first is damaged"),
        ("DELETE FROM world", read_world, "the simulated world of run first is damaged"),
    ],
)
async def test_origin_and_world_are_verified(
    tmp_path: Path, statement: str, read: Callable[[Path, str], object], said: str
) -> None:
    file = await written(tmp_path)
    change(file, statement)
    with pytest.raises(JournalError, match=said):
        read(file, "first")


async def test_no_flipped_byte_changes_what_is_read(tmp_path: Path) -> None:
    """Any byte of the file: the same is read as before, or it is told that the file, or an event of it, is damaged."""
    file = await written(tmp_path)
    before, whole = everything(file), file.read_bytes()
    random_numbers = random.Random(14)
    found = 0
    for _ in range(120):
        at, flip = random_numbers.randrange(len(whole)), random_numbers.randrange(1, 256)
        found += _is_found(file, whole, at, flip, before)
    assert found > 10


async def test_no_flipped_bit_in_the_text_of_an_event_is_missed(tmp_path: Path) -> None:
    file = await written(tmp_path)
    before, whole = everything(file), file.read_bytes()
    texts = [whole.index(f'"message":"step {seq} '.encode()) + 11 for seq in (1, 7, 15)]
    for at in texts:
        for bit in range(8):
            assert _is_found(file, whole, at, 1 << bit, before)


def _is_found(file: Path, whole: bytes, at: int, flip: int, before: object) -> bool:
    """Tell whether a changed byte is told; it must not change what is read."""
    file.write_bytes(whole[:at] + bytes([whole[at] ^ flip]) + whole[at + 1 :])
    try:
        read = everything(file)
    except JournalError as error:
        if str(file) not in str(error):
            raise
        return True
    finally:
        for beside in (f"{file}-wal", f"{file}-shm"):
            Path(beside).unlink(missing_ok=True)
    told = any(run.damage for run in list_runs(file))
    assert told or read == before, f"byte {at} ^ {flip:#x} changed what is read"
    return told


@pytest.mark.parametrize("version", [1, 2, 3])
async def test_a_run_of_an_older_version_is_read_and_said_to_be_unverified(tmp_path: Path, version: int) -> None:
    file = tmp_path / "journal.db"
    events = tuple(said(seq) for seq in range(1, 6))
    write_older_journal(file, version, "old", events)
    (run,) = list_runs(file)
    assert (run.verified, run.damage, run.interrupted, run.last_seq) == (False, "", True, 5)
    assert read_events(file, "old") == events
    assert (read_world(file, "old") is not None, read_origin(file, "old") is not None) == (version > 1, version > 1)


@pytest.mark.parametrize("version", [1, 2, 3])
async def test_a_run_of_an_older_version_goes_on_with_checksums(tmp_path: Path, version: int) -> None:
    file = tmp_path / "journal.db"
    events = tuple(said(seq) for seq in range(1, 6))
    write_older_journal(file, version, "old", events)
    with Journal.open(file, inline=True) as journal:
        assert read_events(file, "old") == events
        run = journal.resume("old")
        assert read_events(file, "old") == events
        run.append(said(6))
        run.append(said(7))
        run.keep_world(b"now")
        await run.commit()
    (record,) = list_runs(file)
    assert (record.verified, record.damage, record.last_seq) == (False, "", 7)
    assert read_events(file, "old") == (*events, said(6), said(7))
    assert read_world(file, "old") is not None
    assert PastRuns(file, success=lambda run, document: ()).all()[0].status == "running"
    change(file, "UPDATE event SET time_s = 0 WHERE seq = 6")
    with pytest.raises(JournalError, match="event 6 of run old is damaged"):
        read_events(file, "old")
