"""The wings take names from the faces of the engine's rooms: what a room keeps inside it may change."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
WINGS = ("states", "robots", "editor_web")
SUBJECTS = ("host", "messages", "skills")
"""Rooms whose files are faces themselves, one for each subject: nobody loads all of them."""
INNER_FACES = {
    "engine.bus.json_bus": "access by name with JSON, for pages and commands; runs do without",
    "engine.cell.cell_connection": "the room has no face: a cell is opened by `engine.project`",
    "engine.cell.robot_models": "as above; what the package that knows the models offers",
    "engine.editing.cell_references": "asked by one route",
    "engine.editing.catalogue": "asked by one route",
    "engine.editing.document_diff": "asked by two routes",
    "engine.editing.fixes": "a room of its own inside editing",
    "engine.editing.references": "asked by one route",
    "engine.editing.target_checks": "has a process of its own",
    "engine.project.bus_inspector": "the composition root has no face: it would load all that executes and edits",
    "engine.project.run_request": "as above",
    "engine.recording.indexed_recording": "reads past recordings, which runs do not",
    "engine.runtime.control": "the face of the room inside `runtime`",
    "engine.runtime.history.hot_change": "`runtime` has no face: each of its rooms is loaded when it is needed",
    "engine.runtime.history.resume": "as above",
    "engine.runtime.history.userdata_history": "as above",
    "engine.runtime.record.nonfinite": "as above",
    "engine.runtime.run_options": "as above",
}
"""What the wings may import from inside a room, with the reason."""
STILL = {"editor_web/http_bodies/document_bodies.py": {"engine.document.yaml_source"}}
"""Files that still reach into a room whose face offers what they need, or should."""


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


def test_the_wings_import_from_faces() -> None:
    """Export a name from the room's `__init__` with `__all__` instead of reaching for its file."""
    assert _reached() == STILL


@pytest.mark.parametrize("module", INNER_FACES)
def test_an_inner_face_is_still_needed(module: str) -> None:
    files = (path for wing in WINGS for path in (ROOT / wing).rglob("*.py") if "node_modules" not in path.parts)
    assert any(f"from {module} import" in path.read_text(encoding="utf-8") for path in files)
