"""One concept, one word: names of public classes and files are unique, and retired words do not come back."""

from __future__ import annotations

import io
import re
import tokenize
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.house.retired_words import GLOSSARY, PROSE, retired_words, words_of
from tests.house.source_file import source_file

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("engine", "states", "robots", "editor_web")
SOURCES = [
    path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py")) if "node_modules" not in path.parts
]
SHARED_FILE_NAMES = {"__init__", "models", "errors", "kernels"}
"""A folder's layers share these by design."""
TERMS = {"three_way_merge", "hand_rests", "MetaPathFinder"}
"""A term of the field that the glossary has, a key of documents, and a class of Python, with a retired word."""
DOCS = [path for path in sorted((ROOT / "docs").rglob("*.md")) if path != GLOSSARY]


def _public_classes() -> Iterator[tuple[str, Path]]:
    for path in SOURCES:
        for name in source_file(path).classes:
            yield name, path


def _family(path: Path) -> str:
    """Return the family of the states in a file: its folder, in `states/` or of a kind of tool; empty for others."""
    if path.is_relative_to(ROOT / "states"):
        return path.relative_to(ROOT / "states").parts[0]
    return path.parent.name if "    state_name: ClassVar[str] = " in path.read_text(encoding="utf-8") else ""


def test_a_public_class_name_has_one_meaning() -> None:
    """Only a state shares its name, with the skill that it performs; states are told apart by their family."""
    places: dict[str, list[Path]] = defaultdict(list)
    skills: set[str] = set()
    states: set[str] = set()
    others: set[str] = set()
    for name, path in _public_classes():
        family = "" if path.is_relative_to(ROOT / "engine") else _family(path)
        places[f"{family}.{name}" if family else name].append(path)
        if family:
            states.add(name)
        elif path.is_relative_to(ROOT / "engine" / "skills"):
            skills.add(name)
        else:
            others.add(name)
    assert {name: paths for name, paths in places.items() if len(paths) > 1} == {}
    assert "On" in states
    assert states & others == set()
    assert skills & others == set()


@pytest.mark.parametrize("package", ["engine", "robots", "editor_web"])
def test_a_file_name_occurs_once_in_a_package(package: str) -> None:
    """So that a name in a traceback or a search leads to one place; a command is named like what it works on."""
    commands = ROOT / "engine" / "cli"
    files = [path for path in SOURCES if path.is_relative_to(ROOT / package) and not path.is_relative_to(commands)]
    names = Counter(path.stem for path in files)
    assert {name: count for name, count in names.items() if count > 1 and name not in SHARED_FILE_NAMES} == {}


@pytest.mark.parametrize("package", [*PACKAGES, "tests", "benchmarks"])
def test_retired_words_are_in_no_name_of_a_file_class_or_function(package: str) -> None:
    """The field's word is beside each in the glossary; tests are named by sentences in plain English."""
    retired, plain = retired_words()
    terms = retired - plain
    files = [path for path in sorted((ROOT / package).rglob("*.py")) if "node_modules" not in path.parts]
    assert files
    sources = [(source_file(path), path) for path in files]
    used = [(name, path) for source, path in sources for name in (path.stem, *source.classes, *source.functions)]
    assert [
        f"{path.relative_to(ROOT)}: {name}"
        for name, path in used
        if name not in TERMS and words_of(name) & (terms if name.startswith("test_") else retired)
    ] == []


@pytest.mark.parametrize("package", [*PACKAGES, "benchmarks", "docs"])
def test_retired_words_are_in_no_attribute_parameter_or_local(package: str) -> None:
    """Nor in what is passed by a name; in tests they stand as plain English."""
    retired, _ = retired_words()
    retired |= {f"{word}s" for word in retired}
    files = [path for path in sorted((ROOT / package).rglob("*.py")) if "node_modules" not in path.parts]
    places = [(path.relative_to(ROOT).as_posix(), path) for path in files]
    assert places
    assert [
        f"{place}: {name}"
        for place, path in places
        for name in sorted(source_file(path).assigned - TERMS)
        if words_of(name) & retired
    ] == []


def test_retired_words_that_are_no_plain_english_are_in_no_comment_docstring_or_page() -> None:
    """A word that a reader would take for a term of flexcell is one; `newest first` and the like are English."""
    retired, plain = retired_words()
    words = "|".join(sorted(retired - plain - PROSE))
    pattern = re.compile(rf"(?<![\w`-])(?:{words})s?(?![\w`-])", re.IGNORECASE)
    texts = [(path, _text_of(path)) for path in [*SOURCES, *DOCS]]
    assert [f"{path.relative_to(ROOT)}: {found[0]}" for path, text in texts for found in pattern.finditer(text)] == []


def _text_of(path: Path) -> str:
    """Return the prose of a file: a page, or the comments and docstrings of a module."""
    source = path.read_text(encoding="utf-8")
    if path.suffix == ".md":
        return source
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return "\n".join(
        token.string
        for token in tokens
        if token.type == tokenize.COMMENT or (token.type == tokenize.STRING and token.string.startswith('"""'))
    )
