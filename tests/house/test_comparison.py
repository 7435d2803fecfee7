"""Every line of the page that compares engines names a test that there is, or says what is missing."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LINES = [
    line
    for line in (ROOT / "docs" / "comparison-engines.md").read_text(encoding="utf-8").splitlines()
    if line.startswith("| ") and not line.startswith(("| there", "| here"))
]


def test_the_page_has_lines() -> None:
    assert len(LINES) > 50


@pytest.mark.parametrize("line", LINES)
def test_it_is_shown_or_said_to_be_missing(line: str) -> None:
    shown = line.rstrip("| ").rpartition("|")[2]
    named = re.findall(r"`([\w/]+\.py)(?:::(\w+))?`", shown)
    assert named or "*missing*" in line
    for name, test in named:
        file = ROOT / "tests" / "engine" / name
        assert file.is_file(), name
        assert not test or re.search(rf"^(async )?def {test}\(", file.read_text(encoding="utf-8"), re.MULTILINE), test
