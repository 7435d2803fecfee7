"""A journal that cannot be written any more in mid-motion: both arms are brought to rest, and the reason is told."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document import load_behavior, load_cell
from engine.errors import JournalError
from engine.event import Event, GoalFinished, GoalSent, NodeExited
from engine.messages import JointState
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult

BEHAVIORS = Path(__file__).parents[3] / "behaviors"
REST_RAD_S = 0.02


@dataclass
class FullDisk:
    """A run's journal on a disk with room for so many commits."""

    room: int
    run_id: str = "transfer"
    epoch: int = 1

    def append(self, event: Event) -> None:
        """Take it."""

    async def events(self) -> Sequence[Event]:
        """Have nothing to tell."""
        return ()

    async def apply_backpressure(self) -> None:
        """Nothing waits."""

    def append_world_state(self, state: bytes) -> None:
        """Take it."""

    def on_failure(self, listener: Callable[[JournalError], None]) -> None:
        """Every failure is one of a commit."""

    async def commit(self) -> None:
        """Fail once the disk is full."""
        self.room -= 1
        if self.room < 0:
            raise JournalError("the journal cannot be written: disk full", where="journal.db", hint="free some space")


@pytest.mark.parametrize("room", [6, 11, 23])
def test_both_arms_rest_when_the_disk_is_full(tmp_path: Path, room: int) -> None:
    events: list[Event] = []

    async def main() -> tuple[RunResult, list[float]]:
        document = load_cell(BEHAVIORS / "cells" / "dual_panda.yaml")
        async with OpenCell(document, store_path=str(tmp_path / "store.db")) as cell:
            plan = new_plan(load_behavior(BEHAVIORS / "reconcycle" / "two_arm_transfer.yaml"), load_states())
            run = Run(plan, run="transfer", bus=cell.bus, journal=FullDisk(room))
            run.watch(events.append)
            result = await run.execute()
            assert cell.bus.goals() == ()
            states = [cell.bus.topic(f"{arm}/joint_state", JointState).latest for arm in ("left", "right")]
            return result, [abs(speed) for state in states if state is not None for speed in state.velocity_rad_s]

    result, speeds = run_virtual(main())
    assert (result.status, result.abandoned) == ("errored", ())
    assert result.cause is not None
    assert "disk full (free some space)" in result.cause.chain()[-1].message
    assert len(speeds) == 14
    assert max(speeds) < REST_RAD_S
    sent = {event.goal for event in events if isinstance(event, GoalSent)}
    assert sent == {event.goal for event in events if isinstance(event, GoalFinished)}
    assert [event.path for event in events if isinstance(event, NodeExited)].count("root") == 1
