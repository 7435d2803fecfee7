"""The documents of cells in a project, found by the names of the cells."""

from __future__ import annotations

import os
from pathlib import Path
from typing import cast

from engine.document.text.yaml_source import load_source
from engine.errors import DocumentError


def cell_reference(project: Path, *, cell: str, document: Path) -> str:
    """Return the path by which a document references a cell of its project; empty if no cell has this name.

    Args:
        project: The folder of the project.
        cell: The name of the cell.
        document: The file that contains the reference.
    """
    for file in sorted((project / "behaviors").rglob("*.y*ml")):
        try:
            data = load_source(file).data
        except DocumentError:
            continue  # not a cell that can be opened
        if isinstance(data, dict) and "robots" in data and cast("dict[str, object]", data).get("cell") == cell:
            return Path(os.path.relpath(file, document.parent)).as_posix()
    return ""
