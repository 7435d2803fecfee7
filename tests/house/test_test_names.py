"""A test lies where the code that it tests lies, and bears its name."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.tiers import kinds_of

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests"
MIRRORED = ("engine", "states", "robots", "editor_web", "benchmarks")
"""Packages whose tree the tests repeat; `behaviors`, `house` and `replay` test documents, the repository and runs."""
JOURNEYS = {
    "engine/reference": "a second, simpler interpreter, and the engine compared with it",
    "robots/teaching": "an arm is led by hand; what it did is captured, learned, and executed again",
    "engine/test_defects_of_peers.py": "known defects of other engines, whatever part of ours they would be in",
}
"""Tests of no single module or room, each with what it is instead. Those in a browser are journeys too."""


def _is_named_after_its_source(test: Path) -> bool:
    """Whether a test has the name of a module or room, or of its own room, and perhaps words of what it is about."""
    folder = ROOT / test.parent.relative_to(TESTS)
    names = {folder.name, *(path.stem for path in folder.glob("*.py")), *(room.name for room in folder.glob("*/"))}
    words = test.stem.removeprefix("test_").split("_")
    return folder.is_dir() and any("_".join(words[:count]) in names for count in range(1, len(words) + 1))


def _is_a_journey(test: Path) -> bool:
    place = test.relative_to(TESTS).as_posix()
    return "browser" in kinds_of(test) or any(place == each or place.startswith(f"{each}/") for each in JOURNEYS)


@pytest.mark.parametrize("package", MIRRORED)
def test_a_test_is_named_after_the_module_or_room_that_it_tests(package: str) -> None:
    """`test_lease.py` and `test_lease_…` in `tests/engine/bus/` test `bus/lease.py`; `test_bus_…` tests the room."""
    tests = sorted((TESTS / package).rglob("test_*.py"))
    assert tests
    others = [test for test in tests if not _is_named_after_its_source(test) and not _is_a_journey(test)]
    rule = "name each test_<module or room>.py, or test_<module or room>_<topic>.py, after what is in the same folder"
    assert [str(test.relative_to(ROOT)) for test in others] == [], rule


def test_every_journey_is_one() -> None:
    """What has found its source leaves the list."""
    gone = [each for each in JOURNEYS if not (TESTS / each).exists()]
    assert gone == []
    files = [TESTS / each for each in JOURNEYS if each.endswith(".py")]
    assert [str(file) for file in files if _is_named_after_its_source(file)] == []
