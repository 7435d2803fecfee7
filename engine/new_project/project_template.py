"""The files of a new project, from the template beside this module."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from engine.cell.drivers import cell_schema_text
from engine.document.schema import schema_texts
from engine.errors import FlexcellError

_TEMPLATE = Path(__file__).parent / "template"
_NAME = "PROJECT_NAME"
# So that no tool takes a file of the template for one of this project.
_STORED_WITH = ".txt"
_PACKAGES = frozenset(("engine", "states", "robots", "editor_web", "behaviors", "cells", "tests", "schemas"))


def require_project_name(name: str) -> None:
    """Refuse a name that is none of a Python package, or hides a package of flexcell or a folder of the project.

    Raises:
        FlexcellError: the message says what a name is.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]{0,63}", name):
        hint = "lower-case letters, digits and _, beginning with a letter: it is the name of a Python package too"
        raise FlexcellError(f"`{name}` is no name of a project", hint=hint)
    if name in _PACKAGES:
        raise FlexcellError(f"`{name}` is the name of a package or folder already", hint="choose another name")


def project_files(name: str) -> Mapping[str, bytes]:
    """Return the files of a new project by their paths in its folder."""
    files = dict(_of_template(name))
    files["schemas/cell.schema.json"] = cell_schema_text().encode()
    files["schemas/behavior.schema.json"] = schema_texts()["behavior.schema.json"].encode()
    return files


def _of_template(name: str) -> Iterator[tuple[str, bytes]]:
    for file in sorted(path for path in _TEMPLATE.rglob("*") if path.is_file()):
        path = file.relative_to(_TEMPLATE).as_posix().replace(_NAME, name).removesuffix(_STORED_WITH)
        yield path, file.read_text(encoding="utf-8").replace(_NAME, name).encode()


def write_project(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write files into a new folder, or an empty one.

    Raises:
        FlexcellError: the folder has files already, or cannot be written.
    """
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise FlexcellError(f"{folder} is there already", hint="choose another name, or remove it")
        for path, content in files.items():
            file = folder / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
    except OSError as error:
        where = error.filename or folder
        reason = error.strerror or type(error).__name__
        raise FlexcellError(f"{where} cannot be written: {reason}", hint="choose another folder") from error
