"""The turns of costly tests: together they have all, one alone has what must never be missing."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import pytest

import bootstrap
from tests.conftest import require_known_to_turns
from tests.tiers import ROOT, kinds_of
from tests.turns import ALWAYS, Turn, defined_tests

COSTLY = ROOT / "tests/robots/arm/test_arm_in_physics.py"
FAST = ROOT / "tests/engine/document/test_loader.py"


def turns_with(node_id: str, file: str) -> list[int]:
    """Return the numbers of the turns that have a test."""
    return [number for number in (1, 2, 3) if Turn(number, 3).has(f"{file}::{node_id}", ROOT / file)]


def test_a_costly_test_is_in_one_turn_with_all_its_values() -> None:
    """What its values share is made once."""
    file = COSTLY.relative_to(ROOT).as_posix()
    assert kinds_of(COSTLY)
    names = [f"test_{number}" for number in range(200)]
    assert all(len(turns_with(name, file)) == 1 for name in names)
    assert {tuple(turns_with(name, file)) for name in names} == {(1,), (2,), (3,)}
    assert turns_with("test_a[one]", file) == turns_with("test_a[two::three]", file)


@pytest.mark.parametrize(
    "file",
    [
        FAST.relative_to(ROOT).as_posix(),
        "tests/house/test_audit.py",
        "tests/robots/test_simulated_cell_stop.py",
        "tests/engine/stop/test_relay.py",
        "tests/engine/project/test_session_stops.py",
        "tests/editor_web/test_stop_page.py",
    ],
)
def test_what_is_fast_or_stops_robots_is_in_every_turn(file: str) -> None:
    """It is never left to the next change."""
    assert (ROOT / file).is_file()
    assert all(turns_with(f"test_{number}", file) == [1, 2, 3] for number in range(20))


def test_what_only_sounds_like_a_stop_takes_turns() -> None:
    """The name is read by words."""
    assert not ALWAYS.search("tests/robots/test_stopping_distance.py")


def test_a_file_is_read_in_the_turns_that_have_a_test_of_it() -> None:
    """A fast one in each."""
    names = defined_tests(COSTLY)
    assert len(names) > 2
    for number in range(1, 21):
        turn = Turn(number, 20)
        assert turn.has_any_of(COSTLY) == any(turn.has(name, COSTLY) for name in names)
        assert turn.has_any_of(FAST)
    assert not all(Turn(number, 20).has_any_of(COSTLY) for number in range(1, 21))


def test_tests_of_classes_are_known_and_one_that_is_not_defined_in_its_file_ends_the_run() -> None:
    """It would be in no turn: nobody would see that it is missing."""
    with_class = defined_tests(ROOT / "tests/engine/sweep/test_sweep_execution.py")
    assert (
        "tests/engine/sweep/test_sweep_execution.py::TestFailingRuns::test_each_way_to_fail_is_its_result" in with_class
    )
    item = SimpleNamespace(path=COSTLY, nodeid=f"{COSTLY.relative_to(ROOT).as_posix()}::test_made_by_a_function[1]")
    with pytest.raises(pytest.UsageError, match=r"test_made_by_a_function\[1\] is not defined in its file"):
        require_known_to_turns([cast("pytest.Item", item)])


@pytest.mark.parametrize("text", ["", "3", "0/3", "4/3", "1/0", "a/b", "-1/3", "1/3/3"])
def test_what_is_no_turn_is_refused(text: str) -> None:
    """With what to write."""
    with pytest.raises(ValueError, match="write 2/3"):
        Turn.parse(text)


def test_a_commit_has_one_of_the_turns() -> None:
    """The same for everyone who has that commit."""
    turn = Turn.parse(bootstrap.turn_of_commit())
    assert turn.count == bootstrap.TURNS
    assert bootstrap.turn_of_commit() == f"{turn.number}/{turn.count}"
