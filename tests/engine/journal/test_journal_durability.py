"""Kill and fill-up tests in processes of their own: acknowledged is durable, and a full disk is said."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from engine.journal import list_runs, read_events

ROOT = Path(__file__).parents[3]

WRITER = """
import asyncio, resource, sys
from engine.errors import JournalError
from engine.event import MessageLogged
from engine.journal import Journal

async def main(place, limit_bytes, inline):
    with Journal.open(place, inline=inline) as journal:
        runs = [journal.begin(f"run-{n}", behavior="b", document="d", started_unix_s=0.0) for n in range(3)]
        if limit_bytes:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit_bytes, limit_bytes))

        async def write(run):
            for seq in range(1, 1_000_000):
                run.append(MessageLogged(seq=seq, time_s=0.0, path="root", level="info", message="m" * 200))
                await run.commit()
                print(run.run_id, seq, flush=True)

        ends = await asyncio.gather(*(write(run) for run in runs), return_exceptions=True)
        for run, end in zip(runs, ends):
            print("failed", type(end).__name__, end, flush=True)
            try:
                await run.commit()
            except JournalError as error:
                print("still failed", flush=True)

asyncio.run(main(sys.argv[1], int(sys.argv[2]), sys.argv[3] == "inline"))
"""


def _start(place: Path, limit_bytes: int, mode: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", WRITER, str(place), str(limit_bytes), mode]
    return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def _acknowledged(lines: list[str]) -> dict[str, int]:
    words = [line.split() for line in lines if line.startswith("run-") and line.endswith("\n")]
    return {run: int(seq) for run, seq in words}


@pytest.mark.parametrize("mode", ["inline", "threaded"])
def test_after_a_kill_everything_acknowledged_is_there(tmp_path: Path, mode: str) -> None:
    """kill -9 in the middle of writing loses no event whose commit had returned, and leaves no gap."""
    process = _start(tmp_path, 0, mode)
    assert process.stdout is not None
    assert process.stderr is not None
    lines = [process.stdout.readline() for _ in range(300)]
    process.kill()
    lines += process.stdout.readlines()
    process.wait()
    process.stdout.close()
    process.stderr.close()
    stored = {run: [event.seq for event in read_events(tmp_path, run)] for run in ("run-0", "run-1", "run-2")}
    acknowledged = _acknowledged(lines)
    assert acknowledged, lines
    assert all(len(stored[run]) >= seq for run, seq in acknowledged.items())
    assert all(seqs == list(range(1, len(seqs) + 1)) for seqs in stored.values())
    assert {record.status for record in list_runs(tmp_path)} == {"running"}


@pytest.mark.parametrize("mode", ["inline", "threaded"])
def test_a_full_disk_fails_every_commit_and_keeps_what_was_acknowledged(tmp_path: Path, mode: str) -> None:
    """When no more can be written, every run is told so with path and advice, and nothing hangs."""
    process = _start(tmp_path, 200_000, mode)
    out, errors = process.communicate(timeout=60)
    lines = out.splitlines(keepends=True)
    failures = [line for line in lines if line.startswith("failed JournalError")]
    assert len(failures) == 3, out[-500:] + errors
    assert all(f"{tmp_path / 'journal.db'}: the journal cannot be written" in line for line in failures)
    assert all("check free space" in line for line in failures)
    assert lines.count("still failed\n") == 3
    acknowledged = _acknowledged(lines)
    assert acknowledged
    assert all(len(read_events(tmp_path, run)) >= seq for run, seq in acknowledged.items())
    assert (process.returncode, errors) == (0, "")
