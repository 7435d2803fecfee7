"""Takes files of other programs into a cell: a mesh as a fixture, a URDF without moving joints as a module."""

from __future__ import annotations

import re
import shutil
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from engine.cell.robot_models import RobotModels
from engine.document.cell import cell_of_source
from engine.document.cell_meshes import MESH_SUFFIXES
from engine.document.module_document import MODULE_FILE, module_of_source
from engine.document.text.yaml_source import load_text, parse_source
from engine.editing.cells.cell_edit import AddCellItem
from engine.editing.cells.cell_editing import apply_cell_edits
from engine.editing.versions import write_atomically
from engine.errors import CellError, DocumentError

MESHES, MODULES = "meshes", "modules"
"""The folders beside a cell document in which its meshes and modules are put."""


@dataclass(frozen=True, kw_only=True)
class ImportedFile:
    """What was written for a file, and its name in the cell; `left_out` has a line for all that was not taken."""

    name: str
    kind: str
    files: tuple[Path, ...]
    left_out: tuple[str, ...] = ()


def import_file(
    file: Path, cell: Path, models: RobotModels, *, name: str | None = None, scale: float = 1.0
) -> ImportedFile:
    """Take a file into the cell document `cell`: a mesh becomes a fixture at its origin, a URDF a module beside it.

    Args:
        file: `.stl`, `.obj` or `.dae`, or `.urdf`.
        cell: The cell document; its other bytes stay as they are.
        models: What reads such files.
        name: Its name in the cell, by default that of the file.
        scale: Metres for one unit of a mesh.

    Raises:
        CellError: it is no such file, cannot be used, or its name is taken.
        DocumentError: the cell document is invalid.
    """
    chosen = name if name is not None else _name_of(file)
    if not file.is_file():
        raise CellError("there is no such file", where=str(file))
    match file.suffix.lower():
        case ".urdf":
            return _import_urdf(file, cell, models, name=chosen)
        case suffix if suffix in MESH_SUFFIXES:
            return _import_mesh(file, cell, models, name=chosen, scale=scale)
        case _:
            kinds = ", ".join((*MESH_SUFFIXES, ".urdf"))
            raise CellError("this is no mesh and no URDF", where=str(file), hint=f"give a file that ends in {kinds}")


def _import_mesh(file: Path, cell: Path, models: RobotModels, *, name: str, scale: float) -> ImportedFile:
    for defect in models.mesh_defects(file, scale=scale):
        if defect.unusable:
            raise CellError(defect.message, where=str(file), hint=defect.hint)
    copy = cell.parent / MESHES / f"{name}{file.suffix.lower()}"
    value: dict[str, object] = {"shape": "mesh", "file": copy.relative_to(cell.parent).as_posix()}
    value |= {"scale": scale} if scale != 1.0 else {}
    old = load_text(cell).decode()
    text, refused = apply_cell_edits(
        old,
        [AddCellItem(section="fixtures", name=name, value={**value, "at": {"xyz": [0.0, 0.0, 0.0]}})],
        file=str(cell),
    )
    if refused is not None:
        raise CellError(refused.message, where=str(cell), hint=refused.hint or "give another name with --name")
    cell_of_source(parse_source(text, file=str(cell)), file=cell)
    if copy.exists() and copy.resolve() != file.resolve():
        raise CellError("a file of this name is there already", where=str(copy), hint="give another name with --name")
    with _writing(copy):
        copy.parent.mkdir(parents=True, exist_ok=True)
        if not copy.exists():
            shutil.copyfile(file, copy)
        write_atomically(cell, text)
    return ImportedFile(name=name, kind="fixture", files=(copy, cell))


def _import_urdf(file: Path, cell: Path, models: RobotModels, *, name: str) -> ImportedFile:
    made = models.urdf_module(file, name=name)
    folder = cell.parent / MODULES / name
    document = folder / MODULE_FILE
    if folder.exists():
        raise CellError(
            "a module of this name is there already", where=str(folder), hint="give another name with --name"
        )
    try:
        module_of_source(parse_source(made.text, file=str(document)), file=document)
    except DocumentError as error:
        raise CellError(f"the URDF gives no valid module: {error}", where=str(file), hint="edit the URDF") from error
    with _writing(folder):
        folder.mkdir(parents=True)
        for path, mesh in made.meshes.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(mesh, folder / path)
        write_atomically(document, made.text)
    files = (document, *(folder / path for path in made.meshes))
    return ImportedFile(name=name, kind="module", files=files, left_out=made.left_out)


@contextmanager
def _writing(place: Path) -> Generator[None]:
    """Turn errors of the file system into those of a cell."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise CellError(f"it cannot be written: {reason}", where=str(place), hint="choose another folder") from error


def _name_of(file: Path) -> str:
    plain = re.sub(r"[^a-z0-9_]+", "_", file.stem.lower()).strip("_")[:60]
    return plain if plain[:1].isalpha() else f"mesh_{plain}".rstrip("_")
