"""Checks the mesh files of fixtures: they are there, can be read, are closed and of a plausible size."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path

from engine.cell.mesh_defect import MeshDefect
from engine.cell.robot_models import robot_models
from engine.check.finding import Finding, new_finding
from engine.document.cell_bodies import Fixture
from engine.document.module_document import Module
from engine.document.text.yaml_source import DocumentSource

_MISSING = MeshDefect(message="there is no such file", hint="give its path from this document", unusable=True)


def check_meshes(fixtures: Mapping[str, Fixture], source: DocumentSource, folder: Path) -> Iterator[Finding]:
    """Yield the findings of the meshes of fixtures, whose files are relative to `folder`."""
    for name, fixture in fixtures.items():
        if fixture.file is None:
            continue
        for defect in inspected_mesh((folder / fixture.file).resolve(), fixture.scale):
            code = "unusable-mesh" if defect.unusable else "suspect-mesh"
            message, position = f"`{fixture.file}`: {defect.message}", source.position(("fixtures", name, defect.key))
            yield new_finding(code, message, path="", position=position, hint=defect.hint)


def missing_meshes(fixtures: Mapping[str, Fixture], source: DocumentSource, folder: Path) -> Iterator[Finding]:
    """Yield the findings of meshes that are not there; no file is read."""
    for name, fixture in fixtures.items():
        if fixture.file is not None and not (folder / fixture.file).is_file():
            position = source.position(("fixtures", name, "file"))
            message = f"`{fixture.file}`: {_MISSING.message}"
            yield new_finding("unusable-mesh", message, path="", position=position, hint=_MISSING.hint)


def check_module(module: Module) -> tuple[Finding, ...]:
    """Return the findings of a module."""
    return tuple(check_meshes(module.document.fixtures, module.source, module.file.parent))


def inspected_mesh(file: Path, scale: float) -> tuple[MeshDefect, ...]:
    """Return what is wrong with a mesh file, one unit of which is `scale` metres."""
    try:
        status = file.stat()
    except OSError:
        # The models are not asked for, which may not be installed.
        return (_MISSING,)
    return _inspected(file, scale, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=256)
def _inspected(file: Path, scale: float, changed_ns: int, size: int) -> tuple[MeshDefect, ...]:
    """Inspect a file, once for each content: an editor checks after every change of the document."""
    del changed_ns, size
    models = robot_models()
    return models.mesh_defects(file, scale=scale) if models is not None else ()
