"""The experiment between two poses: there and back as often as told, the same time each."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from engine.event import NodeExited
from tests.behaviors.application import Application, causes, shipped_cell

WAIT_RAD = (-1.1, -1.4915, 1.8008, -1.8801, -1.5708, -1.1)


def test_it_goes_there_and_back_as_often_as_requested(tmp_path: Path) -> None:
    """Every way takes the same time to within a control period or two, and the wait pose is reached."""
    done = Application(behavior="pick_and_place/start_wait.yaml", cell=shipped_cell("ur10"), parameters={"rounds": 4})
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    ends = [event for event in done.log if isinstance(event, NodeExited) and event.path.endswith(("to_wait", "back"))]
    assert [event.outcome for event in ends] == ["reached"] * 8
    took_s = [after.time_s - before.time_s for before, after in pairwise(ends)]
    assert took_s == pytest.approx([took_s[0]] * 7, abs=0.02)
    nearest = min(
        max(abs(angle - due) for angle, due in zip(seen.joints.position_rad, WAIT_RAD, strict=True))
        for seen in done.seen
    )
    assert nearest < 0.005
