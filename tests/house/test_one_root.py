"""Runs are composed in one place: what makes a run, its port, recording, journal or cell stands in `engine/project`."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("engine", "states", "robots", "editor_web")
PARTS = {
    "Run": "engine/runtime/run.py",
    "OpenCell": "engine/cell/open_cell.py",
    "FaultPort": "engine/faults/fault_port.py",
    "Journal.open": "engine/journal/journal.py",
    "NullJournal": "engine/journal/null_journal.py",
    "RunRecording.open": "engine/recording/run_recording.py",
    "Library": "engine/library/behavior_library.py",
}
"""What a run is composed of, with the file that defines it."""
ROOM = Path("engine/project")
OTHERS = {
    ("Run", "engine/replay/replay_run.py"): "a replay has recorded answers instead of a cell",
    ("Library", "engine/editing/document_repository.py"): "the documents of a project, which a session opens",
}
"""What is made elsewhere, with the reason."""


def _made(text: str) -> set[str]:
    """Return what a source calls by its name, or by a name and one attribute: `Run`, `Journal.open`."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(text)):
        match node:
            case ast.Call(func=ast.Name(id=name)):
                found.add(name)
            case ast.Call(func=ast.Attribute(value=ast.Name(id=owner), attr=name)):
                found.add(f"{owner}.{name}")
            case _:
                continue
    return found


@cache
def _calls() -> Mapping[Path, set[str]]:
    files = (
        path for package in PACKAGES for path in (ROOT / package).rglob("*.py") if "node_modules" not in path.parts
    )
    return {path.relative_to(ROOT): _made(path.read_text(encoding="utf-8")) for path in files}


def _places(part: str) -> set[Path]:
    """Return the files that make a part of a run, other than the file that defines it."""
    return {path for path, calls in _calls().items() if part in calls} - {Path(PARTS[part])}


@pytest.mark.parametrize("part", PARTS)
def test_a_part_of_a_run_is_made_in_the_composition_root(part: str) -> None:
    others = {Path(file) for made, file in OTHERS if made == part}
    places = _places(part)
    assert {place for place in places if not place.is_relative_to(ROOM)} == others
    assert (ROOT / PARTS[part]).is_file()


def test_one_file_makes_runs_with_a_cell() -> None:
    """The command line, sessions, the pytest plugin and scripts start runs through it."""
    made = {part: _places(part) for part in ("Run", "OpenCell", "FaultPort")}
    root = {ROOM / "cell_runner.py"}
    assert made == {"Run": root | {Path("engine/replay/replay_run.py")}, "OpenCell": root, "FaultPort": root}


def test_a_call_is_found_however_it_is_nested() -> None:
    """So that a second composition is seen in an argument or a decorator as well."""
    assert _made("with a(Run(plan)) as b:\n    x = [Journal.open(p) for p in q]\n") == {"a", "Run", "Journal.open"}
