"""Tests that the benchmark of failing cameras tells a seeing cell from a blind one."""

from __future__ import annotations

import pytest

from benchmarks.blind_cameras import row, trial
from engine.bus import GoalStatus
from engine.skills.simulated_world import CameraFaultKind


@pytest.mark.parametrize(("kind", "reaches"), [("none", True), ("displaced", False)])
def test_the_motion_reaches_its_goal_only_where_the_cameras_see(kind: CameraFaultKind, reaches: bool) -> None:
    one = trial(kind, 1)
    assert (one.status is GoalStatus.SUCCEEDED, one.touched) == (reaches, False)
    assert row(kind, [one]).split("|")[1:5] == [f" {kind} ", " 1 ", " 0 ", " 1 "]
