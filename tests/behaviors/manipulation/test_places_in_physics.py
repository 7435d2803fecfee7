"""A part is put down only where it has room: a place that is taken, or too deep, is told before anything is touched."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.event import GoalFinished, GoalSent
from engine.testing.behavior_run import CompletedRun
from tests.behaviors.manipulation.test_parts_in_physics import BEHAVIORS, PANDA_HAND, ended, run

CELL = BEHAVIORS / "cells" / "dual_panda.yaml"
FREE = "xyz: [-0.11, -0.28, 0.0275]"
"""The part stands 1.5 mm over the floor of the tray at (-0.11, -0.28); the other part is at (0.11, -0.28)."""


HIGH = PANDA_HAND.replace("turns: 2", "turns: 2, grasp: {xyz: [0, 0, 0.012], xyzw: [1, 0, 0, 0], frame: part}")
"""Held so high that the fingers are out of the way of what the part touches."""
THERE = "region: {center_m: [-0.11, -0.28], size_m: [0.02, 0.02], height_m: [0.02, 0.03]}"


def went(ran: CompletedRun) -> int:
    """How many straight lines the arm has gone."""
    lines = {event.goal for event in ran.events if isinstance(event, GoalSent) and "cart_lin_task" in event.address}
    ends = [event for event in ran.events if isinstance(event, GoalFinished) and event.goal in lines]
    return sum(event.status == "succeeded" for event in ends)


@pytest.mark.parametrize(
    ("xyz", "other"),
    [
        pytest.param("[0.11, -0.28, 0.0275]", "hca_south", id="where another part is"),
        pytest.param("[0.065, -0.28, 0.0275]", "hca_south", id="15 mm into another part, between which no finger is"),
        pytest.param(
            "[0.052, -0.28, 0.0275]",
            "hca_south",
            id="2 mm into the side of another part, all the way down",
            marks=pytest.mark.nightly,
        ),
        pytest.param("[-0.11, -0.28, 0.011]", "tray_south", id="15 mm into the floor of the tray"),
    ],
)
def test_a_part_is_not_put_into_something_else_and_the_reason_names_both(tmp_path: Path, xyz: str, other: str) -> None:
    """The two lines are those of the pick: the arm does not even begin to go down."""
    ran = run(tmp_path, CELL, HIGH.replace(FREE, f"xyz: {xyz}"))
    assert ran.result.cause is not None
    why = ran.result.cause.chain()[-1].message
    assert (ran.outcome, "hca_north" in why, other in why, went(ran)) == ("blocked", True, True, 2), ended(ran)


def test_a_part_is_put_onto_another_one(tmp_path: Path) -> None:
    """40 mm higher, where it would be 1 mm in the other part."""
    higher = "region: {center_m: [0.11, -0.28], size_m: [0.02, 0.02], height_m: [0.06, 0.07]}"
    steps = PANDA_HAND.replace(FREE, "xyz: [0.11, -0.28, 0.065]").replace(THERE, higher)
    assert ended(run(tmp_path, CELL, steps)) == ("placed", "")


def test_a_part_is_not_put_where_an_opening_finger_would_push_its_neighbour(tmp_path: Path) -> None:
    """Part and closed fingers have room there; 62 mm from middle to middle is too near for a finger that opens."""
    ran = run(tmp_path, CELL, PANDA_HAND.replace(FREE, "xyz: [0.11, -0.218, 0.0275]"))
    assert ran.result.cause is not None
    why = ran.result.cause.chain()[-1].message
    assert (ran.outcome, "finger" in why, "hca_south" in why, went(ran)) == ("blocked", True, True, 2), ended(ran)
