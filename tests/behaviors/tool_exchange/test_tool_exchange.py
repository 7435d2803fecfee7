"""An arm takes three tools from their hanger one after the other; what goes wrong is an outcome with its cause."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from engine.document.faults import load_faults
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses
from tests.behaviors.application import BEHAVIORS, Application, causes, shipped_cell
from tests.tiers import nightly

BEHAVIOR = "tool_exchange/tool_exchange.yaml"
CELL = "tool_exchange"
MARKS = {"hanger/pointer": "top_1", "hanger/blade": "top_2", "hanger/lever": "top_3"}
TAKE, PUT = "root/exchange/child/take", "root/exchange/child/put_back"


def with_fault(name: str) -> Application:
    """Return the application with a fault file that ships with it."""
    faults = load_faults(BEHAVIORS / "tool_exchange" / "faults" / f"{name}.yaml")
    return Application(behavior=BEHAVIOR, cell=shipped_cell(CELL), seed=1, faults=faults)


def touched(done: Application, tool: str) -> float:
    """Return how far from the middle of its mark the tip of a tool was when it touched, in metres, in the world."""
    tip = done.cell.document.parts[tool]
    assert tip.tool is not None
    mark = done.cell.document.fixed_frames[MARKS[tool]].xyz
    at = [compose_poses(seen.parts.poses[tool], tip.tool.tcps["tip"].pose()).xyz for seen in done.seen]
    low = [point for point in at if point[2] < mark[2] + 0.0005 and math.dist(point[:2], mark[:2]) < 0.05]
    assert low, f"{tool} did not touch its mark"
    return max(math.dist(point[:2], mark[:2]) for point in low)


@pytest.mark.parametrize("seed", [1, *map(nightly, range(2, 21))])
def test_each_tool_touches_its_mark_and_hangs_in_its_place_again(tmp_path: Path, seed: int) -> None:
    """The world judges: the tip of the true tool is within 1 mm of the mark, and each tool within 1 mm of its place."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell(CELL), seed=seed)
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    assert done.left.count(f"{TAKE} taken") == done.left.count(f"{PUT} put") == 3
    assert max(touched(done, tool) for tool in MARKS) < 0.001
    for tool in MARKS:
        assert _away_m(done, tool, done.last(tool)) < 0.001


def _away_m(done: Application, tool: str, pose: Pose) -> float:
    return math.dist(pose.xyz, done.cell.document.parts[tool].at.pose().xyz)


@pytest.mark.parametrize(
    ("name", "left", "reason"),
    [
        ("stuck_lock", f"{TAKE} not_locked", "tool_locked is off after 0.5 s"),
        ("no_plate", f"{TAKE} missing", "tool_present is off: no plate is at the face"),
        ("dropped", "root/exchange/child/check lost", "hanger/pointer came off"),
    ],
)
def test_each_fault_is_an_outcome_with_its_cause(tmp_path: Path, name: str, left: str, reason: str) -> None:
    """A tool that was not taken still hangs in its place; one that was dropped does not."""
    done = with_fault(name)
    result = done.run(tmp_path)
    assert result.outcome == "failed"
    assert left in done.left
    assert reason in causes(result)
    away_m = _away_m(done, "hanger/pointer", done.last("hanger/pointer"))
    assert away_m > 0.01 if name == "dropped" else away_m < 0.001
