"""The architecture holds: import contracts, no circles, no file that tells about its making."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from tests.house.source_file import source_file

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("engine", "states", "robots", "editor_web")
SOURCES = sorted(
    path for package in PACKAGES for path in (ROOT / package).rglob("*.py") if "node_modules" not in path.parts
)


def test_the_wings_stand_on_the_engine_and_never_on_one_another() -> None:
    """The contracts in pyproject.toml are kept."""
    lint = Path(sys.executable).with_name("lint-imports")
    done = subprocess.run([lint], cwd=ROOT, capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode == 0, done.stdout


def _name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _imports(path: Path, known: set[str]) -> set[str]:
    found: set[str] = set()
    for module, names, _ in source_file(path).imports:
        found |= {module, *(f"{module}.{name}" for name in names or ())}
    return {name for name in found if name in known} - {_name(path)}


def test_no_modules_import_one_another_in_a_circle() -> None:
    """Imports run one way, typing imports included."""
    names = {_name(path): path for path in SOURCES}
    # A package's own face imports its files; the files never need the face of their own package.
    graph = {name: _imports(path, set(names)) for name, path in names.items() if path.name != "__init__.py"}
    state: dict[str, str] = {}

    def visit(name: str, trail: tuple[str, ...]) -> None:
        assert state.get(name) != "open", " → ".join((*trail[trail.index(name) :], name))
        if name not in graph or state.get(name) == "done":
            return
        state[name] = "open"
        for target in sorted(graph[name]):
            visit(target, (*trail, name))
        state[name] = "done"

    for name in graph:
        visit(name, ())


def _mistakes(path: Path) -> Iterator[str]:
    if not source_file(path).docstring:
        yield "no docstring"
    lines = path.read_text(encoding="utf-8").count("\n")
    if lines > 420:
        yield f"{lines} lines: move one of its subjects into a file of its own"
    if path.stem in ("utils", "util", "helpers", "common", "manager", "misc"):
        yield "a name that says nothing"


def test_each_file_says_what_it_is_for_and_keeps_to_one_subject() -> None:
    """A docstring in the first line, at most 420 lines, and no grab-bag names."""
    assert len(SOURCES) > 1000
    assert {_name(path): mistakes for path in SOURCES if (mistakes := [*_mistakes(path)])} == {}


def test_a_file_without_a_docstring_that_is_too_long_and_called_helpers_has_three_mistakes(tmp_path: Path) -> None:
    file = tmp_path / "helpers.py"
    file.write_text("x = 1\n" * 421, encoding="utf-8")
    assert len([*_mistakes(file)]) == 3
