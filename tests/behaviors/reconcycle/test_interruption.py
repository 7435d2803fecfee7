"""Ctrl-C and kill in mid-motion: both arms come to rest, the journal is closed, exit code 130."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path

import pytest

from engine.errors import JournalError
from engine.event import AnyEvent, Exited, GoalFinished, GoalSent, RunEnded
from engine.journal import list_runs, read_events
from tests.engine.cli.command import FLEXCELL

BEHAVIOR = Path(__file__).resolve().parents[3] / "behaviors" / "reconcycle" / "two_arm_transfer.yaml"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_both_arms_come_to_rest_in_mid_motion(tmp_path: Path, number: signal.Signals) -> None:
    """Every goal that was sent has a confirmed end before the run ends, and every state left once.

    A goal ends as canceled only when the arm is measured at rest.
    """
    command = [FLEXCELL, "run", BEHAVIOR, "--clock", "real", "-q"]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        while len(_moving(_events(tmp_path))) < 2:
            assert process.poll() is None, process.stderr
        process.send_signal(number)
        _, errors = process.communicate(timeout=60)
    events = _events(tmp_path)
    ends = {event.goal: event.status for event in events if isinstance(event, GoalFinished)}
    cancelled = [goal for goal, status in ends.items() if status == "canceled"]
    preempted = [event.path for event in events if isinstance(event, Exited) and event.preempted]
    assert process.returncode == 130, errors
    assert _moving(events) == set()
    assert len(cancelled) == 2, ends
    assert sorted(preempted) == sorted(set(preempted))
    assert isinstance(events[-1], RunEnded)
    assert list_runs(tmp_path / ".flexcell")[0].status == "stopped"


def _events(folder: Path) -> tuple[AnyEvent, ...]:
    try:
        (run,) = list_runs(folder / ".flexcell")
        return read_events(folder / ".flexcell", run.id)
    except (JournalError, ValueError):
        return ()  # not begun yet


def _moving(events: tuple[AnyEvent, ...]) -> set[str]:
    """Goals of arms that are under way, by the journal."""
    sent = {event.goal for event in events if isinstance(event, GoalSent) and "gripper" not in event.address}
    return sent - {event.goal for event in events if isinstance(event, GoalFinished)}
