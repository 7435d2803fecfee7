"""A disk that really is full: a small one in memory, mounted for the command alone."""

from __future__ import annotations

import json
import subprocess
from functools import cache
from pathlib import Path

import pytest

from engine.journal import list_runs, read_events
from tests.engine.cli.command import FLEXCELL

LOOP = """
flexcell: 1
name: loop
outcomes: [done]
success: [done]
root:
  machine:
    initial: wait
    states:
      wait: {state: flow.Wait, with: {duration_s: 0.001}, transitions: {done: wait}}
"""
MOUNT = "mount -t tmpfs -o size={size} none disk"


def alone(script: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run a script that may mount what nobody else sees."""
    command = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", script]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=100, check=False)


@cache
def can_mount() -> bool:
    try:
        return alone("mount -t tmpfs none /mnt", Path("/")).returncode == 0
    except OSError:
        return False


@pytest.mark.skipif(not can_mount(), reason="this system lets nobody mount a disk in memory")
def test_a_run_without_robots_ends_with_exit_code_3_and_the_reason(tmp_path: Path) -> None:
    """It commands nothing, so that no effect waits for the journal; and its recording is not what ends it."""
    (tmp_path / "loop.yaml").write_text(LOOP, encoding="utf-8")
    (tmp_path / "disk").mkdir()
    ended = alone(
        f"{MOUNT.format(size='400k')}; {FLEXCELL} run loop.yaml --json --journal disk --record disk/r.mcap;"
        " code=$?; mkdir kept; cp disk/* kept; exit $code",
        tmp_path,
    )
    result = json.loads(ended.stdout)
    assert (ended.returncode, result["status"], result["success"], result["outcome"]) == (3, "errored", False, None)
    assert "journal.db" in str(result["cause"])
    assert "the journal cannot be written: database or disk is full (the disk is full: free some space)" in str(result)
    assert "r.mcap" in ended.stderr
    (run,) = list_runs(tmp_path / "kept")
    assert (run.interrupted, run.damage) == (True, "")
    assert len(read_events(tmp_path / "kept", run.id)) == run.last_seq


@pytest.mark.skipif(not can_mount(), reason="this system lets nobody mount a disk in memory")
def test_a_run_that_cannot_even_begin_says_so(tmp_path: Path) -> None:
    (tmp_path / "loop.yaml").write_text(LOOP, encoding="utf-8")
    (tmp_path / "disk").mkdir()
    ended = alone(f"{MOUNT.format(size='4k')}; {FLEXCELL} run loop.yaml --journal disk", tmp_path)
    assert ended.returncode == 2
    assert "journal.db: the journal cannot be opened: " in ended.stderr
    assert "free some space" in ended.stderr
