"""One concept, one word: names of public classes and files are unique, and retired words do not come back."""

from __future__ import annotations

import ast
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("engine", "states", "robots", "editor_web")
SOURCES = [
    path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py")) if "node_modules" not in path.parts
]
GLOSSARY = ROOT / "docs" / "reference" / "glossary.md"
SHARED_FILE_NAMES = {"__init__", "models", "errors", "kernels"}
"""A folder's layers share these by design."""


def _public_classes(files: Iterable[Path] = SOURCES) -> Iterator[tuple[str, Path]]:
    for path in files:
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                yield node.name, path


def _words(name: str) -> set[str]:
    """Split `WayFinder` or `way_finder` into its words, in lower case."""
    return {word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z0-9]+", name)}


def _retired() -> set[str]:
    """Return the words that the glossary lists as retired."""
    _, _, part = GLOSSARY.read_text(encoding="utf-8").partition("## Retired words")
    assert part, "the glossary has the section"
    return set(re.findall(r"^\| `(\w+)` \|", part, re.MULTILINE))


def test_a_public_class_name_has_one_meaning() -> None:
    """Only a state shares its name, with the skill that it performs; states are told apart by their family."""
    places: dict[str, list[Path]] = defaultdict(list)
    for name, path in _public_classes():
        family = path.relative_to(ROOT / "states").parts[0] + "." if path.is_relative_to(ROOT / "states") else ""
        places[family + name].append(path)
    assert {name: paths for name, paths in places.items() if len(paths) > 1} == {}
    skills = {name for name, path in _public_classes() if path.is_relative_to(ROOT / "engine" / "skills")}
    states = {name for name, path in _public_classes() if path.is_relative_to(ROOT / "states")}
    others = {
        name
        for name, path in _public_classes()
        if not path.is_relative_to(ROOT / "states") and not path.is_relative_to(ROOT / "engine" / "skills")
    }
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
def test_retired_words_are_in_no_name_of_a_file_or_class(package: str) -> None:
    """The field's word is beside each in `docs/reference/glossary.md`; names of test functions are sentences."""
    retired = _retired()
    assert len(retired) > 20
    files = [path for path in sorted((ROOT / package).rglob("*.py")) if "node_modules" not in path.parts]
    assert files
    used = [(path.stem, path) for path in files] + list(_public_classes(files))
    assert [(name, str(path)) for name, path in used if _words(name) & retired] == []
