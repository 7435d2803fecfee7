"""Every line of the page that compares engines names a test that there is, or says what is missing."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
LINES = [
    line
    for line in (ROOT / "docs" / "comparison-engines.md").read_text(encoding="utf-8").splitlines()
    if line.startswith("| ") and not line.startswith(("| there", "| here"))
]


def test_the_page_has_lines() -> None:
    assert len(LINES) > 50


def test_each_is_shown_or_said_to_be_missing() -> None:
    for line in LINES:
        shown = line.rstrip("| ").rpartition("|")[2]
        named = re.findall(r"`([\w/]+\.py)(?:::(\w+))?`", shown)
        assert named or "*missing*" in line, line
        for name, test in named:
            file = ROOT / "tests" / "engine" / name
            assert file.is_file(), name
            text = file.read_text(encoding="utf-8")
            assert not test or re.search(rf"^(async )?def {test}\(", text, re.MULTILINE), f"{name}::{test}"
