"""Retired words are in no name of the page either: of its files, of what they declare, of its classes of CSS."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.house.retired_words import PROSE, ROOT, retired_words, words_of

PAGE = ROOT / "editor_web" / "frontend" / "src"
GENERATED = PAGE / "api" / "types.ts"
COMMENT = re.compile(r"/\*.*?\*/|(?<![:'\"])//[^\n]*", re.DOTALL)
DECLARED = re.compile(
    r"\b(?:const|let|function|class|interface|type|enum)\s+(\w+)"
    r"|\b(?:const|let) \[(\w+(?:, \w+)*)\]"
    r"|\{ (\w+(?:: \w+)?(?:, \w+(?:: \w+)?)*) \}"
    r"|^\s+(?:readonly )?(\w+)\??:\s"
    r"|[({,]\s*(\w+)(?=\??: |\) =>|, \w+\) =>)",
    re.MULTILINE,
)
"""Names of variables, functions and types, of fields, and of parameters."""
CSS_NAME = re.compile(r"\.([a-zA-Z][\w-]*)|--([\w-]+)")


def page_files(*suffixes: str) -> list[Path]:
    """Return the sources of the page with these suffixes; its tests are sentences in plain English."""
    files = [
        path
        for path in sorted(PAGE.rglob("*"))
        if path.suffix in suffixes and ".test." not in path.name and path != GENERATED
    ]
    assert len(files) > 10
    return files


def names_in(source: str, pattern: re.Pattern[str]) -> set[str]:
    """Return the names that a pattern finds outside comments."""
    code = COMMENT.sub("", source)
    return {name for found in pattern.findall(code) for group in found for name in re.findall(r"[\w-]+", group)}


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("const [told, setTold] = useState('')", {"told", "setTold"}),
        ("function f({ path, way }: { path: string; way: number }) {}", {"f", "path", "way"}),
        ("  readonly way?: string\n// const other = 1", {"way"}),
        ("rows.map((way, index) => way)", {"way"}),
    ],
)
def test_names_are_found(source: str, names: set[str]) -> None:
    """What the next tests read; a pattern that finds nothing would let all pass."""
    assert names <= names_in(source, DECLARED)
    assert "other" not in names_in(source, DECLARED)


def test_retired_words_are_in_no_name_of_the_page() -> None:
    """The field's word is beside each in the glossary."""
    retired, _ = retired_words()
    retired |= {f"{word}s" for word in retired}
    named = [
        (name, path)
        for path in page_files(".ts", ".tsx")
        for name in (path.stem, *sorted(names_in(path.read_text(encoding="utf-8"), DECLARED)))
    ]
    named += [
        (name, path)
        for path in page_files(".css")
        for name in sorted(names_in(path.read_text(encoding="utf-8"), CSS_NAME))
    ]
    assert [f"{path.relative_to(PAGE)}: {name}" for name, path in named if words_of(name) & retired] == []


def test_retired_words_that_are_no_plain_english_are_in_no_comment_of_the_page() -> None:
    """As in the comments of Python; out of sight, and the moments of a run, are plain English here."""
    retired, plain = retired_words()
    words = "|".join(sorted(retired - plain - PROSE - {"moments", "sight"}))
    pattern = re.compile(rf"(?<![\w`-])(?:{words})s?(?![\w`-])", re.IGNORECASE)
    texts = [
        (path, "\n".join(COMMENT.findall(path.read_text(encoding="utf-8"))))
        for path in page_files(".ts", ".tsx", ".css")
    ]
    assert [f"{path.relative_to(PAGE)}: {found[0]}" for path, text in texts for found in pattern.finditer(text)] == []
