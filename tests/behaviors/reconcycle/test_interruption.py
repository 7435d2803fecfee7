"""Ctrl-C and kill in mid-motion: both arms come to rest, the journal is closed, exit code 130."""

from __future__ import annotations

import signal
from collections.abc import Sequence
from pathlib import Path

import pytest

from engine.event import AnyEvent, GoalFinished, GoalSent, NodeExited, RunEnded
from engine.journal import list_runs
from tests.engine.cli.process import events_in, started, until
from tests.robots.sim.demo_cell import patient_copy

BEHAVIOR = Path(__file__).resolve().parents[3] / "behaviors" / "reconcycle" / "two_arm_transfer.yaml"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_both_arms_come_to_rest_in_mid_motion(tmp_path: Path, number: signal.Signals) -> None:
    """Every goal that was sent has a confirmed end before the run ends, and every state left once.

    A goal ends as canceled only when the arm is measured at rest.
    """
    # So slow that both are still under way when the signal comes, however late that is.
    slowly = ("-p", "speed=0.05", "-p", "line_speed_m_s=0.02")
    cell = ("--cell", str(patient_copy(tmp_path)))
    with started("run", BEHAVIOR, "--clock", "real", "-q", *cell, *slowly, cwd=tmp_path) as process:
        until(process, tmp_path, lambda events: len(_moving(events)) == 2)
        process.send_signal(number)
        _, errors = process.communicate(timeout=60)
    events = events_in(tmp_path)
    ends = {event.goal: event.status for event in events if isinstance(event, GoalFinished)}
    cancelled = [goal for goal, status in ends.items() if status == "canceled"]
    preempted = [event.path for event in events if isinstance(event, NodeExited) and event.preempted]
    assert process.returncode == 130, errors
    assert _moving(events) == set()
    assert len(cancelled) == 2, ends
    assert sorted(preempted) == sorted(set(preempted))
    assert isinstance(events[-1], RunEnded)
    assert list_runs(tmp_path / ".flexcell")[0].status == "stopped"


def _moving(events: Sequence[AnyEvent]) -> set[str]:
    """Goals of arms that are under way, by the journal."""
    sent = {event.goal for event in events if isinstance(event, GoalSent) and "gripper" not in event.address}
    return sent - {event.goal for event in events if isinstance(event, GoalFinished)}
