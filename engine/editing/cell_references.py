"""The documents of cells in a project, found by the names of the cells."""

from __future__ import annotations

import os
from pathlib import Path
from typing import cast

from engine.document.yaml_source import load_source
from engine.errors import DocumentError


def cell_reference(project: Path, *, cell: str, document: Path) -> str:
    """Return the path by which a document names a cell of its project; empty where there is none of that name.

    Args:
        project: The folder of the project.
        cell: The name of the cell.
        document: The file that is to refer to it.
    """
    for file in sorted((project / "behaviors").rglob("*.y*ml")):
        try:
            data = load_source(file).data
        except DocumentError:
            continue  # whatever it is, it is no cell that could be opened
        if isinstance(data, dict) and "robots" in data and cast("dict[str, object]", data).get("cell") == cell:
            return Path(os.path.relpath(file, document.parent)).as_posix()
    return ""
