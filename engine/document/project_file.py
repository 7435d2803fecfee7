"""Project files: which Python modules the documents of a folder may name.

    flexcell: 1
    states: [my_cell.settle, my_cell.inspection]

`flexcell.yaml` is in the project folder, next to `behaviors/`. Modules in that folder can be
imported. Nothing else causes an import: neither behaviors nor recordings nor journals.
"""

from __future__ import annotations

import stat
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.document_file import DocumentFile
from engine.document.text.yaml_source import load_source
from engine.errors import Position

PROJECT_FILE = "flexcell.yaml"

ModuleName = Annotated[
    str,
    Meta(
        pattern=r"^[A-Za-z_][A-Za-z0-9_]*(\.[A-Za-z_][A-Za-z0-9_]*)*$",
        max_length=256,
        description="A Python module, for example `my_cell.settle`, without a class",
    ),
]


class ProjectDocument(StrictModel, frozen=True, kw_only=True):
    """A project as written. `states` are the modules whose classes documents may name as `module:Class`."""

    flexcell: Literal[1]
    states: Annotated[tuple[ModuleName, ...], Meta(max_length=1000)] = ()


@dataclass(frozen=True, kw_only=True)
class ProjectFile(DocumentFile[ProjectDocument]):
    """A project document with its file."""

    @property
    def folder(self) -> Path:
        """The project folder; modules in it can be imported."""
        return self.file.parent

    def position(self, index: int) -> Position:
        """Return the position of a module in `states`."""
        return self.source.position(("states", index))


def load_project(file: Path) -> ProjectFile:
    """Read a project file.

    Raises:
        DocumentError: it cannot be read or is no valid project file; `where` is the position.
    """
    source = load_source(file)
    return ProjectFile(document=decode_document(source, ProjectDocument), file=file.resolve(), source=source)


def find_project(start: Path) -> ProjectFile | None:
    """Read the project file of the folder `start` (or of the file's folder), or of the nearest one around it.

    A file in a world-writable folder, such as `/tmp`, is ignored.

    Raises:
        DocumentError: the project file is invalid.
    """
    here = start.resolve()
    for folder in (here, *here.parents):
        file = folder / PROJECT_FILE
        if file.is_file() and not folder.stat().st_mode & stat.S_IWOTH:
            return load_project(file)
    return None
