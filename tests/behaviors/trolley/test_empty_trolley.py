"""A trolley is plugged in, its blocks are carried to a rack, and it leaves without them, with what is still on it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from engine.document.cell import load_cell
from engine.event import NodeExited
from tests.behaviors.application import BEHAVIORS, Application, causes, shipped_cell
from tests.tiers import nightly

BEHAVIOR = "trolley/empty_trolley.yaml"
PLACES = [(x, y) for y in (-0.26, -0.38) for x in (0.365, 0.455, 0.545, 0.635)]


@pytest.mark.parametrize("blocks", [[1], nightly([5, 1, 8]), nightly([1, 2, 3, 4, 5, 6, 7, 8])], ids=str)
def test_the_blocks_are_on_the_rack_and_the_others_leave_with_the_trolley(tmp_path: Path, blocks: list[int]) -> None:
    """At first no block is in the cell; while the trolley is there, all are; in the end those that were carried."""
    done = Application(behavior=BEHAVIOR, cell=shipped_cell("trolley"), seed=2, parameters={"blocks": blocks})
    result = done.run(tmp_path)
    assert (result.outcome, causes(result)) == ("finished", "")
    assert (done.left[0], done.left[-2]) == ("root/plug plugged", "root/unplug unplugged")
    last = done.seen[-1].parts.poses
    assert set(last) == {f"trolley/block_{number}" for number in blocks}
    for number in blocks:
        x, y, z = last[f"trolley/block_{number}"].xyz
        assert math.dist((x, y), PLACES[number - 1]) < 0.004
        assert z == pytest.approx(0.19, abs=1e-3)
    plugged = next(event.time_s for event in done.log if isinstance(event, NodeExited))
    meanwhile = [seen for seen in done.seen if plugged < seen.time_s < done.seen[-1].time_s - 1.0]
    assert all(len(seen.parts.poses) == 8 for seen in meanwhile)


def test_a_trolley_that_is_in_the_way_of_the_arm_is_not_plugged_and_the_behavior_says_why(tmp_path: Path) -> None:
    """The connector is where the arm is at its home."""
    text = (BEHAVIORS / "cells" / "trolley.yaml").read_text(encoding="utf-8")
    moved = text.replace("{xyz: [0.5, 0.32, 0]}", "{xyz: [0.45, 0, 0.3]}").replace(
        "../modules", str(BEHAVIORS / "modules")
    )
    (tmp_path / "cell.yaml").write_text(moved, encoding="utf-8")
    cell = load_cell(tmp_path / "cell.yaml")
    done = Application(behavior=BEHAVIOR, cell=cell, parameters={"blocks": [1]})
    result = done.run(tmp_path)
    assert result.outcome == "failed"
    assert "trolley cannot be plugged to north: arm/panda_" in causes(result)
    assert done.seen[-1].parts.poses == {}
