"""The experiment between two poses with a planner: around a box on the table, by each planner of the experiment."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from engine.event import NodeExited
from tests.behaviors.application import Application, causes, shipped_cell
from tests.tiers import nightly

BEHAVIOR = "pick_and_place/start_wait_free.yaml"
WAIT_RAD = (-1.1, -1.4915, 1.8008, -1.8801, -1.5708, -1.1)
START_RAD = (-2.0762, -1.4915, 1.8008, -1.8801, -1.5708, -2.0762)


@pytest.mark.parametrize("planner", ["fast", nightly("RRTConnect")])
def test_it_goes_there_and_back_around_the_box(tmp_path: Path, planner: str) -> None:
    """Straight from joints to joints the tool would cut through it, as the next test shows."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("ur10"), parameters={"rounds": 2, "planner": planner})
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    ends = [event for event in done.log if isinstance(event, NodeExited) and event.path.endswith(("to_wait", "back"))]
    assert [event.outcome for event in ends] == ["reached"] * 4
    assert done.seen[-1].joints.position_rad == pytest.approx(START_RAD, abs=0.01)
    assert detour_rad(done) > 0.2


def test_without_the_box_the_way_is_straight(tmp_path: Path) -> None:
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("ur10"), parameters={"rounds": 2, "obstacle": False})
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    assert detour_rad(done) < 0.02


def detour_rad(done: Application) -> float:
    """How far the arm went off the straight joint line between start and wait in the rounds."""
    began_s = next(
        event.time_s for event in done.log if isinstance(event, NodeExited) and event.path == "root/to_start"
    )
    return max(_off_the_line(seen.joints.position_rad) for seen in done.seen if seen.time_s > began_s + 0.2)


def _off_the_line(joints: tuple[float, ...]) -> float:
    line = [b - a for a, b in zip(START_RAD, WAIT_RAD, strict=True)]
    off = [q - a for a, q in zip(START_RAD, joints, strict=True)]
    along = sum(a * b for a, b in zip(line, off, strict=True)) / sum(a * a for a in line)
    return math.dist(off, [along * a for a in line])
