"""Every row of the features of the page has a mark, says what is in the way, and names tests that there are."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
FRONT_END = ROOT / "editor_web" / "frontend" / "src"
PAGE = ROOT / "docs" / "reference" / "editor-features.md"
ROW = re.compile(r"^\| (\d+) \| (.+?) \| (works|friction|missing) \| (.*?) ?\| (.+) \|$", re.MULTILINE)
ROWS = ROW.findall(PAGE.read_text(encoding="utf-8"))


def test_there_are_52_rows() -> None:
    assert [int(number) for number, *_ in ROWS] == list(range(1, 53))


def test_each_row_is_shown_by_tests() -> None:
    for number, feature, mark, friction, shown in ROWS:
        assert bool(friction) == (mark != "works"), f"{number}, {feature}: say what is in the way, if it is"
        named = re.findall(r"`([\w/.]+)::([^`]+)`", shown)
        assert len(named) == shown.count("`") // 2 > 0, f"{number}, {feature}: name its tests"
        for file, test in named:
            assert is_a_test(file, test), f"{number}, {feature}: {file} has no test {test!r}"


def is_a_test(file: str, test: str) -> bool:
    """Whether a file has a test of this name: of Python its function, of the page the words that it is called by."""
    place = ROOT / "tests" / file if file.endswith(".py") else FRONT_END / file
    if not place.is_file():
        return False
    text = place.read_text(encoding="utf-8")
    if file.endswith(".py"):
        return re.search(rf"^(async )?def {re.escape(test)}\(", text, re.MULTILINE) is not None
    return re.search(rf"\b(it|test)(\.each\(.*\))?\('{re.escape(test)}'", text) is not None


def test_a_name_that_no_test_has_is_none() -> None:
    assert not is_a_test("editor_web/test_page.py", "test_it_fits")
    assert not is_a_test("document/folding.test.ts", "draws a folded container")
    assert not is_a_test("document/nowhere.test.ts", "draws")
