"""`flexcell run --faults`: faults reach the states, stand in the log, and kill the process if so told."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import pytest

from engine.event import ServiceCalled
from engine.journal import list_runs, read_events
from tests.engine.cli.command import CommandOutput, flexcell

BEHAVIOR = """
flexcell: 1
name: write
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: write
    states:
      write:
        state: store.WriteEntry
        with: {kind: record, name: tray}
        in: {value: tray}
        on_error: failed
        transitions: {written: finished, conflict: failed}
"""
CELL = "flexcell: 1\ncell: shelf\nstore: {kind: sqlite, path: cell.db}\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A behavior that writes an entry into the store of its cell."""
    document = BEHAVIOR.replace("outcomes: [fin", "userdata: {tray: {rows: 4}}\noutcomes: [fin")
    (tmp_path / "write.yaml").write_text(document, encoding="utf-8")
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    return tmp_path


def _run(folder: Path, faults: str, *more: str) -> CommandOutput:
    (folder / "faults.yaml").write_text(f"flexcell: 1\nfaults:\n{faults}\n", encoding="utf-8")
    return flexcell("run", "write.yaml", "--clock", "virtual", "--faults", "faults.yaml", *more, cwd=folder)


def test_a_fault_reaches_the_state_and_the_log(folder: Path) -> None:
    """The one that never came up is named on stderr, also beside --json."""
    faults = "- {at: root/write, address: store/**, error: the disk is full}\n- {at: root/wirte, hang: {}}"
    said = _run(folder, faults, "--json", "--events", "run.jsonl")
    result = json.loads(said.out)
    assert (said.code, result["outcome"]) == (1, "failed")
    assert "the disk is full" in str(result["cause"])
    assert said.err == (
        "flexcell: fault 2 (hang, faults.yaml:4:3) was never applied: no state at root/wirte sent a request to **\n"
    )
    events = [json.loads(line) for line in (folder / "run.jsonl").read_text(encoding="utf-8").splitlines()]
    (fault,) = [event for event in events if event["event"] == "fault"]
    assert (fault["path"], fault["address"], fault["detail"]) == (
        "root/write", "store/write_entry", "fails: the disk is full",
    )  # fmt: skip
    assert [event["level"] for event in events if event["event"] == "log"] == ["warning"]


def test_progress_shows_faults(folder: Path) -> None:
    """Where and what."""
    said = _run(folder, "- {name: slow disk, late: 2 s}")
    assert said.code == 0
    assert "root/write  fault injected at store/write_entry: slow disk, the response is 2 s late" in said.err


@pytest.mark.parametrize("crash", ["{on_request: before}", "{at_event: 4}"])
def test_a_crash_kills_the_process_and_leaves_a_journal_to_resume(folder: Path, crash: str) -> None:
    """As `kill -9`: what was due before the request is durable, and the run has no end."""
    said = _run(folder, f"- crash: {crash}", "--journal", "runs")
    assert said.code == -signal.SIGKILL
    (run,) = list_runs(folder / "runs")
    events = read_events(folder / "runs", run.id)
    assert (run.status, any(isinstance(event, ServiceCalled) for event in events)) == ("running", "request" in crash)


def test_a_bad_fault_document_is_exit_code_2(folder: Path) -> None:
    """Nothing is started; the line says where and what to do."""
    said = _run(folder, "- {at: root, hang: {}, late: 1 s}")
    assert (said.code, said.err) == (
        2, "flexcell: faults.yaml:3:14: this fault has both `late` and `hang` (split it into two faults)\n",
    )  # fmt: skip
