"""The words that the glossary retires, for the tests that look for them."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GLOSSARY = ROOT / "docs" / "reference" / "glossary.md"
PROSE = {"bench", "looking", "nearby", "newest", "tell", "told", "trouble"}
"""Words that are plain English in texts too, beside those that are so in names of tests."""


@cache
def words_of(name: str) -> frozenset[str]:
    """Split `WayFinder` or `way_finder` into its words, in lower case."""
    return frozenset(word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z0-9]+", name))


def retired_words() -> tuple[set[str], set[str]]:
    """Return the words that the glossary lists as retired, and those that stand as plain English in names of tests."""
    _, _, part = GLOSSARY.read_text(encoding="utf-8").partition("## Retired words")
    introduction, table, rows = part.partition("\n| word |")
    assert table, "the glossary has the section"
    retired = set(re.findall(r"^\| `(\w+)` \|", rows, re.MULTILINE))
    plain = set(re.findall(r"`(\w+)`", introduction))
    assert len(retired) > 20
    assert plain < retired
    return retired, plain
