"""One step of a paused run: what it lets go, and where it stops again."""

from __future__ import annotations

import pytest

from engine.runtime.control.breakpoint import GatePoint
from engine.runtime.control.single_step import SingleStep, StepMode

POINTS: list[tuple[str, GatePoint]] = [
    ("root/pick/grasp/close", "before"),
    ("root/pick/grasp/close", "after"),
    ("root/pick/grasp", "before"),
    ("root/pick/grasp", "after"),
    ("root/pick/lift", "before"),
    ("root/pick", "before"),
    ("root/pick", "after"),
    ("root/place", "before"),
    ("root/place", "after"),
    ("root", "after"),
    ("other/one", "before"),
    ("other/one", "after"),
]
INSIDE = ("root/pick/grasp/close", "before")
AGAIN = ("root/pick/grasp", "before")
NEXT = ("root/pick/lift", "before")
CONTAINER_AGAIN = ("root/pick", "before")
BEYOND = ("root/place", "before")


@pytest.mark.parametrize(
    ("mode", "ends"),
    [
        ("into", {INSIDE, AGAIN, NEXT, CONTAINER_AGAIN, BEYOND}),
        ("over", {AGAIN, NEXT, CONTAINER_AGAIN, BEYOND}),
        ("out", {("root/pick", "after"), BEYOND, ("root/place", "after"), ("root", "after")}),
    ],
)
def test_a_step_ends_where_its_mode_says_and_in_no_other_branch(mode: StepMode, ends: set[tuple[str, str]]) -> None:
    """From `root/pick/grasp`, in the branch `root`."""
    step = SingleStep(mode=mode, branch="root", origin="root/pick/grasp")
    assert {point for point in POINTS if step.ends_at(*point)} == ends


@pytest.mark.parametrize("mode", ["into", "over", "out"])
def test_a_step_from_nowhere_ends_at_the_next_entry_in_any_branch(mode: StepMode) -> None:
    step = SingleStep(mode=mode, branch="", origin="")
    assert [point for point in POINTS if step.ends_at(*point)] == [point for point in POINTS if point[1] == "before"]


def test_a_step_lets_go_its_branch_and_what_is_around_it() -> None:
    step = SingleStep(mode="into", branch="root/pick", origin="root/pick/grasp")
    paths = ["root", "root/pick", "root/pick/grasp", "root/pick_two", "root/place"]
    assert [path for path in paths if step.frees(path)] == ["root", "root/pick", "root/pick/grasp"]
    assert all(SingleStep(mode="over", branch="", origin="").frees(path) for path in paths)


def test_an_undo_lets_go_nothing_around_its_node_and_ends_by_itself() -> None:
    step = SingleStep(mode="back", branch="root/pick", origin="root/pick")
    assert [path for path in ("root", "root/pick", "root/pick/grasp", "root/place") if step.frees(path)] == [
        "root/pick",
        "root/pick/grasp",
    ]
    assert [point for point in POINTS if step.ends_at(*point)] == []
