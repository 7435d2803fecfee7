"""The wings take names from the faces of the engine's rooms: what a room keeps inside it may change."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

from tests.house.source_file import source_file

ROOT = Path(__file__).resolve().parents[2]
WINGS = ("states", "robots", "editor_web")
SUBJECTS = ("host", "messages", "skills")
"""Rooms whose files are faces themselves, one for each subject: nobody loads all of them."""


def _names_of(face: str) -> list[str]:
    """Return the names that a package offers; none if it is a module or a package without a face."""
    module = import_module(face)
    return getattr(module, "__all__", []) if hasattr(module, "__path__") else []


def _from_inside(path: Path) -> Iterator[str]:
    """Yield what a file imports from a room of the engine and its face, or the face of a room in it, does not offer."""
    for module, names, level in source_file(path).imports:
        if level or not _is_room(module):
            continue
        if names is None:
            yield from [module] if module.count(".") > 1 else []
        else:
            offered = _names_of(module)
            yield from (f"{module}.{name}" for name in names if name not in offered)


def _is_room(module: str) -> bool:
    """Say whether a module is a room of the engine, or is inside one, whose files are not faces themselves."""
    parts = module.split(".")
    return (
        parts[0] == "engine" and len(parts) > 1 and parts[1] not in SUBJECTS and (ROOT / "engine" / parts[1]).is_dir()
    )


@pytest.mark.parametrize("wing", WINGS)
def test_a_wing_imports_from_faces(wing: str) -> None:
    """Export a name from the room's `__init__` with `__all__` instead of reaching for its file."""
    files = [path for path in (ROOT / wing).rglob("*.py") if "node_modules" not in path.parts]
    found = {path.relative_to(ROOT).as_posix(): sorted(_from_inside(path)) for path in files}
    assert {file: names for file, names in found.items() if names} == {}


@pytest.mark.parametrize(
    ("line", "names"),
    [
        ("from engine.document import Behavior", []),
        ("from engine.skills.motion import MoveTo", []),
        ("from engine.clock import Clock", []),
        ("from engine.document import placement", ["engine.document.placement"]),
        ("from engine.document.text.yaml_source import MAX_BYTES", ["engine.document.text.yaml_source.MAX_BYTES"]),
        ("import engine.project.session", ["engine.project.session"]),
    ],
)
def test_only_what_a_face_offers_is_no_way_inside(tmp_path: Path, line: str, names: list[str]) -> None:
    file = tmp_path / "wing.py"
    file.write_text(line, encoding="utf-8")
    assert list(_from_inside(file)) == names
