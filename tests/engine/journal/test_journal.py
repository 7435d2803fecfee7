"""A journal keeps what it acknowledged, in order, for all runs, and fails loudly and for good."""

from __future__ import annotations

import asyncio
import sqlite3
import threading
from collections.abc import Sequence
from pathlib import Path

import pytest

from engine.errors import JournalError
from engine.event import MessageLogged, RunEnded
from engine.journal import Journal, JournalPort, NullJournal, RunJournal, RunRecord, list_runs, read_events
from engine.journal.batch import WriteBatch
from engine.journal.database import JournalDatabase
from engine.journal.group_commit import MAX_PENDING_EVENTS

BOTH = pytest.mark.parametrize("inline", [True, False], ids=["inline", "threaded"])


def logged(seq: int, message: str = "x") -> MessageLogged:
    """Make an event."""
    return MessageLogged(seq=seq, time_s=seq * 0.5, path="root", level="info", message=message)


def begun(journal: Journal, run: str = "run-1") -> RunJournal:
    """Begin a run."""
    return journal.begin(run, behavior="transfer", document="abc", started_unix_s=10.0)


@BOTH
async def test_what_was_committed_is_read_back_while_the_journal_is_open(tmp_path: Path, inline: bool) -> None:
    """A reader sees the committed events and no more."""
    with Journal.open(tmp_path, inline=inline) as journal:
        run = begun(journal)
        for seq in (1, 2, 3):
            run.append(logged(seq))
        await run.commit()
        run.append(logged(4))
        assert read_events(tmp_path, "run-1") == (logged(1), logged(2), logged(3))


async def test_an_inline_journal_writes_while_events_gather_without_a_commit(tmp_path: Path) -> None:
    """A loop of hours in virtual time has its events on the disk, not in memory."""
    with Journal.open(tmp_path, inline=True) as journal:
        run = begun(journal)
        for seq in range(1, 20_001):
            run.append(logged(seq))
        assert len(read_events(tmp_path, "run-1")) > 20_000 - 5_000


async def test_a_run_that_is_faster_than_the_writer_waits_for_it(tmp_path: Path) -> None:
    """However much comes without a wait in between, few events are in memory when it goes on."""
    with Journal.open(tmp_path) as journal:
        run = begun(journal)
        run.append(logged(1))
        await run.apply_backpressure()
        for seq in range(2, 100_001):
            run.append(logged(seq))
        await run.apply_backpressure()
        assert len(read_events(tmp_path, "run-1")) > 100_000 - 20_000


async def test_a_run_waits_for_events_that_the_writer_has_taken_and_not_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are in memory too: a write that takes its time counts as pending."""
    taken, written = threading.Semaphore(0), threading.Semaphore(0)
    store = JournalDatabase.store

    def stored_slowly(database: JournalDatabase, batches: Sequence[WriteBatch]) -> None:
        taken.release()
        written.acquire()
        store(database, batches)

    with Journal.open(tmp_path) as journal:
        run = begun(journal)
        monkeypatch.setattr(JournalDatabase, "store", stored_slowly)
        for seq in range(1, MAX_PENDING_EVENTS + 1):
            run.append(logged(seq))
        await asyncio.to_thread(taken.acquire)
        for seq in range(MAX_PENDING_EVENTS + 1, 3 * MAX_PENDING_EVENTS + 1):
            run.append(logged(seq))
        written.release()
        await asyncio.to_thread(taken.acquire)
        waiting = asyncio.create_task(run.apply_backpressure())
        done, _ = await asyncio.wait([waiting], timeout=0.05)
        written.release(100)
        assert not done
        await waiting
        assert len(read_events(tmp_path, "run-1")) == 3 * MAX_PENDING_EVENTS


@BOTH
async def test_closing_writes_what_no_commit_asked_for_and_may_be_repeated(tmp_path: Path, inline: bool) -> None:
    """`close` flushes; closing again does nothing."""
    journal = Journal.open(tmp_path / "runs.db", inline=inline)
    begun(journal).append(logged(1))
    journal.close()
    journal.close()
    assert read_events(tmp_path / "runs.db", "run-1") == (logged(1),)


@BOTH
async def test_after_closing_a_commit_says_that_the_journal_is_closed(tmp_path: Path, inline: bool) -> None:
    """No commit hangs on a closed journal."""
    journal = Journal.open(tmp_path, inline=inline)
    run = begun(journal)
    journal.close()
    run.append(logged(1))
    with pytest.raises(JournalError, match="the journal is closed"):
        await asyncio.wait_for(run.commit(), 30)


async def test_branches_and_runs_commit_side_by_side_and_lose_nothing(tmp_path: Path) -> None:
    """Sixteen runs that commit at once all find every event of theirs."""
    with Journal.open(tmp_path) as journal:
        runs = [begun(journal, f"run-{n}") for n in range(16)]

        async def write(run: RunJournal) -> None:
            for seq in range(1, 21):
                run.append(logged(seq))
                await run.commit()

        await asyncio.gather(*(write(run) for run in runs))
        stored = [read_events(tmp_path, run.run_id) for run in runs]
    assert stored == [tuple(logged(seq) for seq in range(1, 21))] * 16


async def test_commits_are_acknowledged_in_the_order_they_were_asked_for(tmp_path: Path) -> None:
    """Who asked first is told first."""
    told: list[int] = []
    with Journal.open(tmp_path) as journal:
        run = begun(journal)

        async def write(seq: int) -> None:
            run.append(logged(seq))
            await run.commit()
            told.append(seq)

        await asyncio.gather(*(write(seq) for seq in range(1, 51)))
    assert told == list(range(1, 51))


async def test_a_cancelled_commit_disturbs_nobody(tmp_path: Path) -> None:
    """The event of a cancelled waiter is written all the same."""
    with Journal.open(tmp_path) as journal:
        run = begun(journal)
        run.append(logged(1))
        waiting = asyncio.create_task(run.commit())
        await asyncio.sleep(0)
        waiting.cancel()
        await asyncio.wait([waiting])
        run.append(logged(2))
        await run.commit()
        assert read_events(tmp_path, "run-1") == (logged(1), logged(2))


@BOTH
async def test_the_end_of_a_run_sets_its_status(tmp_path: Path, inline: bool) -> None:
    """The list of runs tells what each became."""
    with Journal.open(tmp_path, inline=inline) as journal:
        first, second = begun(journal, "run-1"), begun(journal, "run-2")
        first.append(RunEnded(seq=1, time_s=2.0, status="finished", outcome="done"))
        second.append(logged(1))
        await first.commit()
        await second.commit()
        runs = list_runs(tmp_path)
    assert [(run.id, run.status) for run in runs] == [("run-1", "finished"), ("run-2", "running")]
    assert runs[0] == RunRecord(
        id="run-1",
        behavior="transfer",
        document="abc",
        status="finished",
        epoch=1,
        started_unix_s=10.0,
        last_seq=1,
    )


@BOTH
async def test_an_engine_whose_run_was_taken_over_can_write_no_more(tmp_path: Path, inline: bool) -> None:
    """Two engines on one file: the one that resumed goes on, the other is fenced for that run only."""
    with Journal.open(tmp_path, inline=inline) as old, Journal.open(tmp_path, inline=inline) as new:
        before, beside = begun(old, "run-1"), begun(old, "run-2")
        before.append(logged(1))
        await before.commit()
        after = new.resume("run-1")
        before.append(logged(2, "zombie"))
        with pytest.raises(JournalError, match=r"run run-1 is driven by another engine now \(epoch 2\)"):
            await before.commit()
        with pytest.raises(JournalError, match="another engine"):
            await before.commit()
        beside.append(logged(1))
        await beside.commit()
        after.append(logged(2, "successor"))
        await after.commit()
        assert after.epoch == 2
        assert read_events(tmp_path, "run-1") == (logged(1), logged(2, "successor"))
        assert read_events(tmp_path, "run-2") == (logged(1),)


@BOTH
async def test_an_event_that_cannot_be_written_stops_its_own_run_only(tmp_path: Path, inline: bool) -> None:
    """A strange value in the userdata of one run does not cost another its journal."""
    with Journal.open(tmp_path, inline=inline) as journal:
        bad, good = begun(journal, "bad"), begun(journal, "good")
        bad.append(MessageLogged(seq=1, time_s=0.0, path="root", level="info", message="\ud800"))
        good.append(logged(1))
        ends = await asyncio.gather(bad.commit(), good.commit(), return_exceptions=True)
        assert [type(end) for end in ends] == [JournalError, type(None)]
        assert "event 1 (MessageLogged) cannot be written as JSON" in str(ends[0])
        assert (read_events(tmp_path, "bad"), read_events(tmp_path, "good")) == ((), (logged(1),))


@BOTH
async def test_the_same_sequence_number_twice_is_refused(tmp_path: Path, inline: bool) -> None:
    """An append-only journal overwrites nothing."""
    with Journal.open(tmp_path, inline=inline) as journal:
        run = begun(journal)
        run.append(logged(1, "first"))
        await run.commit()
        run.append(logged(1, "again"))
        with pytest.raises(JournalError, match="event 1 is already stored"):
            await run.commit()
    assert read_events(tmp_path, "run-1") == (logged(1, "first"),)


@BOTH
async def test_an_event_whose_predecessor_is_missing_is_refused(tmp_path: Path, inline: bool) -> None:
    """A run without gaps is what reading and resuming rely on."""
    with Journal.open(tmp_path, inline=inline) as journal:
        run, other = begun(journal), begun(journal, "run-2")
        run.append(logged(1))
        run.append(logged(3))
        other.append(logged(1))
        with pytest.raises(JournalError, match="event 3 arrived where event 2 was expected"):
            await run.commit()
        await other.commit()
    assert [record.last_seq for record in list_runs(tmp_path)] == [0, 1]


@BOTH
async def test_a_locked_file_fails_the_run_for_good_and_no_other(tmp_path: Path, inline: bool) -> None:
    """What lost events stays failed when the lock goes away; what lost none goes on, and the next run begins."""
    with Journal.open(tmp_path, inline=inline, busy_timeout_s=0.01) as journal:
        run, other, idle = runs = [begun(journal, f"run-{n}") for n in (1, 2, 3)]
        for each in runs:
            await each.commit()
        thief = sqlite3.connect(journal.path, isolation_level=None)
        thief.execute("BEGIN IMMEDIATE")
        run.append(logged(1))
        with pytest.raises(
            JournalError, match=r"journal\.db: the journal cannot be written: .*locked.*end that program"
        ):
            await run.commit()
        with pytest.raises(JournalError, match="locked"):
            await begun(journal, "run-4").commit()
        thief.close()
        for run_journal in runs:
            run_journal.append(logged(2 if run_journal is run else 1))
        await other.commit()
        await idle.commit()
        with pytest.raises(JournalError, match="locked"):
            await run.commit()
        begun(journal, "run-4")
    assert [record.last_seq for record in list_runs(tmp_path)] == [0, 1, 1, 0]


@BOTH
async def test_a_failure_that_no_commit_waits_for_is_reported(tmp_path: Path, inline: bool) -> None:
    """A run that only waits hears of it from the commit of another, or from the writer by itself."""
    heard: asyncio.Queue[JournalError] = asyncio.Queue()
    with Journal.open(tmp_path, inline=inline, busy_timeout_s=0.01) as journal:
        waiting, other = begun(journal, "run-1"), begun(journal, "run-2")
        waiting.on_failure(heard.put_nowait)
        thief = sqlite3.connect(journal.path, isolation_level=None)
        thief.execute("BEGIN IMMEDIATE")
        waiting.append(logged(1))
        other.append(logged(1))
        with pytest.raises(JournalError, match="locked"):
            await other.commit()
        assert "locked" in (await asyncio.wait_for(heard.get(), 30)).message
        thief.close()
    assert heard.empty()


def test_closing_reports_a_failure_that_no_commit_had_reported(tmp_path: Path) -> None:
    """What only `close` could find out is not swallowed."""
    journal = Journal.open(tmp_path, busy_timeout_s=0.01)
    run = begun(journal)
    thief = sqlite3.connect(journal.path, isolation_level=None)
    thief.execute("BEGIN IMMEDIATE")
    run.append(logged(1))
    with pytest.raises(JournalError, match="locked"):
        journal.close()
    thief.close()


async def test_a_defect_in_the_writer_reaches_the_waiting_commit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even an error nobody foresaw ends a commit instead of hanging it."""
    from engine.journal.database import JournalDatabase

    def broken(*_: object) -> None:
        raise ZeroDivisionError("oops")

    with Journal.open(tmp_path) as journal:
        run = begun(journal)
        monkeypatch.setattr(JournalDatabase, "store", broken)
        for seq in (1, 2):
            run.append(logged(seq))
            with pytest.raises(JournalError, match="the journal writer failed: ZeroDivisionError: oops"):
                await asyncio.wait_for(run.commit(), 30)


@BOTH
async def test_a_run_begins_once(tmp_path: Path, inline: bool) -> None:
    """The same id again is refused and told to resume; the first goes on, and so do others of the same group."""
    with Journal.open(tmp_path, inline=inline) as journal:
        first = begun(journal)
        await first.commit()
        other = begun(journal, "run-2")
        with pytest.raises(JournalError, match=r"run run-1 already exists \(resume it\)"):
            await begun(journal).commit()
        first.append(logged(1))
        await first.commit()
        await other.commit()
    assert [(record.id, record.last_seq) for record in list_runs(tmp_path)] == [("run-1", 1), ("run-2", 0)]


async def test_a_run_begins_without_waiting_for_a_disk_that_is_slow(tmp_path: Path) -> None:
    """The event loop goes on while another program holds the file, and with it what keeps arms moving."""
    with Journal.open(tmp_path, busy_timeout_s=30.0) as journal:
        thief = sqlite3.connect(journal.path, isolation_level=None)
        thief.execute("BEGIN IMMEDIATE")
        run = begun(journal)
        entered = asyncio.create_task(run.commit())
        await asyncio.sleep(0)
        assert not entered.done()
        assert list_runs(tmp_path) == ()
        thief.close()
        await entered
        assert [record.id for record in list_runs(tmp_path)] == ["run-1"]


async def test_a_run_that_is_closed_before_its_first_commit_has_begun(tmp_path: Path) -> None:
    """Closing writes what is pending."""
    with Journal.open(tmp_path) as journal:
        begun(journal)
    assert [(record.id, record.status) for record in list_runs(tmp_path)] == [("run-1", "running")]


def test_an_unknown_run_cannot_be_resumed(tmp_path: Path) -> None:
    """Resuming names the missing run."""
    with Journal.open(tmp_path) as journal, pytest.raises(JournalError, match="there is no run nobody"):
        journal.resume("nobody")


@pytest.mark.parametrize(
    ("content", "message"),
    [(b"this is text, not a database at all" * 40, "not a database.*move it away"), (None, "check that the directory")],
    ids=["text file", "a file where the directory should be"],
)
def test_a_place_that_cannot_be_opened_is_named_with_advice(
    tmp_path: Path, content: bytes | None, message: str
) -> None:
    """What is wrong with the file is said with its path."""
    if content is None:
        (tmp_path / "file").write_text("x")
        place = tmp_path / "file" / "journal.db"
    else:
        place = tmp_path / "journal.db"
        place.write_bytes(content)
    with pytest.raises(JournalError, match=f"journal.db: the journal cannot be opened: .*{message}"):
        Journal.open(place)


def test_a_journal_of_a_newer_format_is_left_alone(tmp_path: Path) -> None:
    """A file from the future is refused, not written to."""
    Journal.open(tmp_path).close()
    with sqlite3.connect(tmp_path / "journal.db") as connection:
        connection.execute("PRAGMA user_version=99")
    connection.close()
    with pytest.raises(JournalError, match="its format is 99, this program knows 5"):
        Journal.open(tmp_path)


async def test_the_null_journal_takes_the_same_calls() -> None:
    """Benchmarks can leave the disk out."""
    journal: JournalPort = NullJournal()
    run = journal.begin("run-1", behavior="transfer", document="abc", started_unix_s=0.0)
    run.append(logged(1))
    await run.commit()
    journal.close()
    assert (run.run_id, run.epoch, journal.resume("run-2").run_id) == ("run-1", 1, "run-2")
