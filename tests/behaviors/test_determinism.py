"""A seed decides everything that happens in an application: physics, tools, planning and engine."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.journal import encode_event_log
from tests.behaviors.application import Application, shipped_cell
from tests.tiers import nightly


@pytest.mark.parametrize(
    ("name", "cell"),
    [
        ("pick_and_place", "ur10"),
        nightly("plate_transfer", "irb4600"),
        nightly("plate_transfer_shared", "irb4600_shared"),
        nightly("test_cylinder", "servo_arm"),
    ],
)
def test_the_same_seed_gives_the_same_events_and_the_same_place_to_the_last_bit(
    tmp_path: Path, name: str, cell: str
) -> None:
    first, second = (Application(behavior=f"{name}/{name}.yaml", cell=shipped_cell(cell), seed=7) for _ in range(2))
    for number, application in enumerate((first, second)):
        (tmp_path / str(number)).mkdir()
        assert application.run(tmp_path / str(number)).outcome == "finished"
    assert encode_event_log(first.log) == encode_event_log(second.log)
    assert first.seen[-1].parts.poses == second.seen[-1].parts.poses
