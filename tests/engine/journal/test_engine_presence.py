"""A journal knows which of its runs an engine drives now, and which were interrupted."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

from engine.event import RunEnded
from engine.journal import Journal, find_run, list_runs
from engine.journal.engine_presence import living_engines, presence_folder
from tests.engine.journal.older_journal import write_older_journal

ROOT = Path(__file__).parents[3]
ENGINE = """
import asyncio, sys
from engine.journal import Journal

with Journal.open(sys.argv[1]) as journal:
    asyncio.run(journal.begin("abroad", behavior="b", document="d", started_unix_s=0.0).commit())
    print("begun", flush=True)
    sys.stdin.read()
"""


async def test_a_run_is_driven_while_its_journal_is_open_and_interrupted_afterwards(tmp_path: Path) -> None:
    with Journal.open(tmp_path) as journal:
        ended = journal.begin("ended", behavior="b", document="d", started_unix_s=0.0)
        await journal.begin("open", behavior="b", document="d", started_unix_s=1.0).commit()
        ended.append(RunEnded(seq=1, time_s=0.0, status="finished", outcome="done"))
        await ended.commit()
        assert [(run.driver, run.interrupted) for run in list_runs(tmp_path)] == [(None, False), (os.getpid(), False)]
    assert [(run.driver, run.interrupted) for run in list_runs(tmp_path)] == [(None, False), (None, True)]
    assert list(presence_folder(tmp_path / "journal.db").iterdir()) == []


def test_a_killed_engine_drives_nothing_and_is_forgotten_by_the_next(tmp_path: Path) -> None:
    command = [sys.executable, "-c", ENGINE, str(tmp_path)]
    with subprocess.Popen(command, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "begun\n"
        assert find_run(tmp_path, "abroad").driver == process.pid
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert find_run(tmp_path, "abroad").interrupted
    with Journal.open(tmp_path) as journal:
        journal.resume("abroad")
        assert list(living_engines(tmp_path / "journal.db").values()) == [os.getpid()]
        assert find_run(tmp_path, "abroad").driver == os.getpid()


def test_a_journal_of_an_older_version_can_be_listed(tmp_path: Path) -> None:
    write_older_journal(tmp_path / "journal.db", 2, "old", ())
    assert [run.interrupted for run in list_runs(tmp_path)] == [True]
    with Journal.open(tmp_path) as journal:
        journal.resume("old")
        assert not find_run(tmp_path, "old").interrupted
