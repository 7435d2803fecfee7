"""A byte of a journal that is not what was written is found by every reader and told with file, run and event."""

from __future__ import annotations

import random
import sqlite3
from collections.abc import Callable
from pathlib import Path

import pytest

from engine.archive.past_runs import PastRuns
from engine.errors import JournalError
from engine.event import MessageLogged, RunEnded
from engine.journal import Journal, RunOrigin, list_runs, read_events, read_origin, read_world
from tests.engine.journal.older_journal import write_format_4, write_older_journal

RUNS = ("first", "second")
EVENTS = 20
A_COMMIT = 6


def logged(seq: int) -> MessageLogged:
    return MessageLogged(
        seq=seq, time_s=seq * 0.5, path="root", level="info", message=f"step {seq} " + "x" * (seq * 7 % 150)
    )


async def written(folder: Path) -> Path:
    """Write a journal of two runs that are over, some events in each commit, and put all of it into the one file."""
    with Journal.open(folder, inline=True) as journal:
        for name in RUNS:
            origin = RunOrigin(behavior="/b.yaml", documents={"b.yaml": "text " * 100})
            run = journal.begin(name, behavior="transfer", document="abc", started_unix_s=10.0, origin=origin)
            for seq in range(1, EVENTS):
                run.append(logged(seq))
                if seq % A_COMMIT == 0 or seq == EVENTS - 1:
                    run.append_world_state(bytes(range(100)))
                    await run.commit()
            run.append(RunEnded(seq=EVENTS, time_s=30.0, status="finished", outcome="done"))
            await run.commit()
    return folder / "journal.db"


def of_format_4(folder: Path) -> Path:
    """Write a journal of the same two runs as version 4 of the format had it, a row for each event."""
    file = folder / "journal.db"
    write_format_4(file)
    return file


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
STEP_7 = "UPDATE {} SET data = CAST(replace(CAST(data AS TEXT), 'step 7', 'step 8') AS BLOB) WHERE run = 'first'"


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        (STEP_7.format("block"), EVENT.format(7)),
        (STEP_7.format("block").replace("'step 8'", "'step 77'"), EVENT.format(7)),
        ("UPDATE block SET data = substr(data, 1, length(data) - 1) WHERE seq = 7", "events 7 to 12 of run first are"),
        ("UPDATE block SET sums = CAST(x'00' || substr(sums, 2) AS BLOB) WHERE seq = 7", EVENT.format(7)),
        ("UPDATE block SET epoch = 2 WHERE run = 'first' AND seq = 7", "events 7 to 12 of run first are damaged"),
        ("UPDATE block SET last = 11 WHERE run = 'first' AND seq = 7", "events 7 to 11 of run first are damaged"),
        ("UPDATE block SET last = 1 << 60 WHERE run = 'first' AND seq = 7", "events 7 to 1152921504606846976 of run"),
        ("UPDATE block SET checksum = x'' WHERE run = 'first' AND seq = 7", "events 7 to 12 of run first are damaged"),
        ("DELETE FROM block WHERE run = 'first' AND seq = 7", "events 13 to 18 of run first are damaged"),
        ("DELETE FROM block WHERE run = 'first' AND seq = 1", "events 7 to 12 of run first are damaged"),
        (
            "UPDATE block SET seq = 99 WHERE run = 'first' AND seq = 7;"
            "UPDATE block SET seq = 7 WHERE run = 'first' AND seq = 13;"
            "UPDATE block SET seq = 13 WHERE run = 'first' AND seq = 99",
            "events 7 to 18 of run first are damaged",
        ),
        (
            "DELETE FROM block WHERE run = 'first' AND seq > 18",
            r"journal\.db: run first has 18 events in the journal, and 20 were written",
        ),
        (
            "UPDATE block SET run = 'second', seq = 21 WHERE run = 'first' AND seq = 20",
            r"run first has 19 events in the journal, and 20 were written",
        ),
        ("UPDATE checksum SET since = 5 WHERE run = 'first'", "the record of run first is damaged"),
    ],
)  # fmt: skip
async def test_a_changed_event_is_reported_with_file_run_and_number(tmp_path: Path, statement: str, said: str) -> None:
    file = await written(tmp_path)
    change(file, statement)
    with pytest.raises(JournalError, match=said):
        read_events(file, "first")


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
    ],
)
@pytest.mark.parametrize("upgraded", [False, True])
def test_a_changed_event_of_format_4_is_reported(tmp_path: Path, statement: str, said: str, upgraded: bool) -> None:
    file = of_format_4(tmp_path)
    change(file, statement)
    if upgraded:
        Journal.open(file).close()
    with pytest.raises(JournalError, match=said):
        read_events(file, "first")


async def test_a_journal_of_format_4_reads_as_one_of_today(tmp_path: Path) -> None:
    for folder in ("old", "new"):
        (tmp_path / folder).mkdir()
    old = of_format_4(tmp_path / "old")
    assert everything(old) == everything(await written(tmp_path / "new"))
    Journal.open(old).close()
    assert everything(old) == everything(tmp_path / "new" / "journal.db")


async def test_a_run_of_format_4_goes_on_in_the_same_chain(tmp_path: Path) -> None:
    file = of_format_4(tmp_path)
    before = read_events(file, "first")
    with Journal.open(file, inline=True) as journal:
        run = journal.resume("first")
        for seq in (21, 22, 23):
            run.append(logged(seq))
        await run.commit()
    assert read_events(file, "first") == (*before, logged(21), logged(22), logged(23))
    first = next(run for run in list_runs(file) if run.id == "first")
    assert (first.last_seq, first.verified, first.damage, first.epoch) == (23, True, "", 2)
    assert PastRuns(file, success=lambda run, document: ()).all()[1].duration_s == logged(23).time_s
    change(file, "DELETE FROM event WHERE run = 'first' AND seq = 20")
    with pytest.raises(JournalError, match="events 21 to 23 of run first are damaged or out of place"):
        read_events(file, "first")
    assert PastRuns(file, success=lambda run, document: ()).all()[1].status == "errored"


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE run SET status = 'running' WHERE id = 'first'",
        "UPDATE run SET behavior = 'another' WHERE id = 'first'",
        "UPDATE run SET started = 11 WHERE id = 'first'",
        "UPDATE run SET epoch = 2 WHERE id = 'first'",
        "UPDATE driver SET engine = 'x' WHERE run = 'first'",
        "DELETE FROM block WHERE run = 'first' AND seq = 20",
        "UPDATE block SET last = 19 WHERE run = 'first' AND seq = 20",
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
    for seq in (1, 7, 15):
        at = whole.index(f'"message":"step {seq} '.encode()) + 11
        for bit in range(8):
            assert _is_found(file, whole, at, 1 << bit, before)
        file.write_bytes(whole[:at] + b"S" + whole[at + 1 :])
        damaged = [run for run in RUNS if f"event {seq} of run {run} is damaged" in _refusal(file, run)]
        assert len(damaged) == 1


def _refusal(file: Path, run: str) -> str:
    try:
        read_events(file, run)
    except JournalError as error:
        return str(error)
    return ""


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
    events = tuple(logged(seq) for seq in range(1, 6))
    write_older_journal(file, version, "old", events)
    (run,) = list_runs(file)
    assert (run.verified, run.damage, run.interrupted, run.last_seq) == (False, "", True, 5)
    assert read_events(file, "old") == events
    assert (read_world(file, "old") is not None, read_origin(file, "old") is not None) == (version > 1, version > 1)


@pytest.mark.parametrize("version", [1, 2, 3])
async def test_a_run_of_an_older_version_goes_on_with_checksums(tmp_path: Path, version: int) -> None:
    file = tmp_path / "journal.db"
    events = tuple(logged(seq) for seq in range(1, 6))
    write_older_journal(file, version, "old", events)
    with Journal.open(file, inline=True) as journal:
        assert read_events(file, "old") == events
        run = journal.resume("old")
        assert read_events(file, "old") == events
        run.append(logged(6))
        run.append(logged(7))
        run.append_world_state(b"now")
        await run.commit()
    (record,) = list_runs(file)
    assert (record.verified, record.damage, record.last_seq) == (False, "", 7)
    assert read_events(file, "old") == (*events, logged(6), logged(7))
    assert read_world(file, "old") is not None
    assert PastRuns(file, success=lambda run, document: ()).all()[0].status == "running"
    change(file, STEP_7.format("block").replace("'first'", "'old'"))
    with pytest.raises(JournalError, match="event 7 of run old is damaged"):
        read_events(file, "old")
