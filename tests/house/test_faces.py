"""States and robots take names from the faces of the engine's rooms: what a room keeps inside it may change."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
WINGS = ("states", "robots")
"""The dashboard is not among them: the bodies of its requests and answers are the structs inside the rooms."""
SUBJECTS = ("host", "messages", "skills")
"""Rooms whose files are faces themselves, one for each subject: nobody loads all of them."""
INNER_FACES = {
    "engine.cell.robot_models": "the room has no face: a cell is opened by `engine.project`",
    "engine.runtime.record.nonfinite": "`runtime` has no face: each of its rooms is loaded when it is needed",
}
"""What the wings may import from inside a room, with the reason."""


def _inner_modules(path: Path) -> Iterator[str]:
    """Yield the modules inside a room of the engine that a file imports from."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names: list[str] = []
        if isinstance(node, ast.ImportFrom) and node.module is not None and node.level == 0:
            names = [node.module]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        for name in names:
            parts = name.split(".")
            if parts[0] == "engine" and len(parts) > 2 and parts[1] not in SUBJECTS:
                yield name


def _reached() -> dict[str, set[str]]:
    """Return what each file of the wings imports from inside a room, other than the inner faces."""
    files = (path for wing in WINGS for path in (ROOT / wing).rglob("*.py") if "node_modules" not in path.parts)
    found = {path.relative_to(ROOT).as_posix(): set(_inner_modules(path)) - set(INNER_FACES) for path in files}
    return {file: modules for file, modules in found.items() if modules}


def test_states_and_robots_import_from_faces() -> None:
    """Export a name from the room's `__init__` with `__all__` instead of reaching for its file."""
    assert _reached() == {}


@pytest.mark.parametrize("module", INNER_FACES)
def test_an_inner_face_is_still_needed(module: str) -> None:
    files = (path for wing in WINGS for path in (ROOT / wing).rglob("*.py") if "node_modules" not in path.parts)
    assert any(f"from {module} import" in path.read_text(encoding="utf-8") for path in files)
