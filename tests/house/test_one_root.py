"""Runs are composed in one place: what makes a run, its port, recording, journal or cell stands in `engine/project`."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.house.source_file import source_file, source_text

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


def _places(part: str) -> set[Path]:
    """Return the files that make a part of a run, other than the file that defines it."""
    files = (
        path for package in PACKAGES for path in (ROOT / package).rglob("*.py") if "node_modules" not in path.parts
    )
    return {path.relative_to(ROOT) for path in files if part in source_file(path).called} - {Path(PARTS[part])}


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
    text = "with a(Run(plan)) as b:\n    x = [Journal.open(p) for p in q]\n"
    assert source_text(text).called == {"a", "Run", "Journal.open"}
