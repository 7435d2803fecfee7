"""Breakpoints: which gate points they are about, when their condition holds, and the file that keeps them."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.errors import DocumentError, ExpressionError
from engine.runtime.control import Breakpoint, load_breakpoints, save_breakpoints
from engine.runtime.control.breakpoint import GatePoint

BEHAVIOR = "pick.yaml"


@pytest.mark.parametrize(
    ("breakpoint_", "matched"),
    [
        (Breakpoint(path="root/one"), {("root/one", "before", "")}),
        (Breakpoint(path="root/one", enabled=False), set[tuple[str, str, str]]()),
        (Breakpoint(path="root/one", when="after"), {("root/one", "after", "a"), ("root/one", "after", "b")}),
        (Breakpoint(path="root/one", when="after", outcomes=("b", "c")), {("root/one", "after", "b")}),
        (Breakpoint(path="root/o?e"), {("root/one", "before", "")}),
        (Breakpoint(path="*"), {("root/one", "before", ""), ("root/two/one", "before", "")}),
        (Breakpoint(path="ROOT/one"), set[tuple[str, str, str]]()),
    ],
)
def test_a_breakpoint_is_about_its_nodes_at_its_point_with_its_outcomes(
    breakpoint_: Breakpoint, matched: set[tuple[str, str, str]]
) -> None:
    points: list[tuple[str, GatePoint, str]] = [
        ("root/one", "before", ""),
        ("root/one", "after", "a"),
        ("root/one", "after", "b"),
        ("root/two/one", "before", ""),
    ]
    assert {point for point in points if breakpoint_.matches(*point)} == matched


@pytest.mark.parametrize("condition", ["n > 2", "${n > 2}"])
def test_a_condition_is_read_from_the_userdata_with_or_without_its_braces(condition: str) -> None:
    each = Breakpoint(path="root", condition=condition)
    assert each.holds({"n": 3}.__getitem__)
    assert not each.holds({"n": 2}.__getitem__)
    assert Breakpoint(path="root").holds(dict[str, object]().__getitem__)


def test_a_condition_that_is_a_number_is_refused_in_words() -> None:
    with pytest.raises(ExpressionError, match=r"root: the condition of the breakpoint evaluates to 3, which is not a"):
        Breakpoint(path="root", condition="n").holds({"n": 3}.__getitem__)


def test_breakpoints_lie_beside_their_behavior_and_are_read_as_they_were_written(tmp_path: Path) -> None:
    """Without any there is no file."""
    behavior = tmp_path / BEHAVIOR
    assert load_breakpoints(behavior) == ()
    kept = (
        Breakpoint(path="root/one", when="after", condition="n > 2", hits=3, outcomes=("a",), enabled=False),
        Breakpoint(path="root/*"),
    )
    save_breakpoints(behavior, kept)
    assert [file.name for file in tmp_path.iterdir()] == ["pick.breakpoints.yaml"]
    assert load_breakpoints(behavior) == kept
    save_breakpoints(behavior, [])
    save_breakpoints(behavior, [])
    assert (list(tmp_path.iterdir()), load_breakpoints(behavior)) == ([], ())


def test_a_condition_that_cannot_be_read_is_refused_with_its_place_in_the_file(tmp_path: Path) -> None:
    """When the file is read, not when the run gets there."""
    file = tmp_path / "pick.breakpoints.yaml"
    file.write_text("flexcell: 1\nbreakpoints:\n  - {path: root}\n  - {path: root/one, if: n >}\n", encoding="utf-8")
    with pytest.raises(DocumentError, match=r"pick\.breakpoints\.yaml:4:\d+") as refused:
        load_breakpoints(tmp_path / BEHAVIOR)
    assert refused.value.hint
