"""The benchmark of inverse kinematics measures every solver that is installed and checks their answers."""

from __future__ import annotations

from benchmarks.ik import Line, lines_of, table
from tests.robots.model.inverse_kinematics.ik_arms import arm


def test_every_solver_is_asked_for_the_same_poses() -> None:
    """Fewer of them where it is slow; the figures of so few mean nothing and are not looked at."""
    lines = lines_of("IRB4600", arm("irb4600"), 20)
    assert [(line.solver, line.poses) for line in lines] == [
        ("flexcell, nearest", 20),
        ("EAIK, any", 20),
        ("flexcell before, nearest", 2),
        ("damped least squares, any", 2),
        ("pin-pink, any", 2),
    ]
    assert [line.solved for line in lines[:2]] == [1.0, 1.0]


def test_ratios_are_of_the_medians_to_ours() -> None:
    """The first line is ours."""
    ours = Line(arm="A", solver="ours", poses=4, solved=1.0, p50_us=20.0, p95_us=50.0, max_us=90.0)
    theirs = Line(arm="A", solver="theirs", poses=4, solved=0.25, p50_us=5000.0, p95_us=6000.0, max_us=7000.0)
    assert table([ours, theirs]).splitlines()[-1] == "| theirs | 4 | 25.0 | 5,000 | 6,000 | 7,000 | 250 |"
