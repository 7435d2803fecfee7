"""The Python source of a registered state class: its file, its lines, and the text."""

from __future__ import annotations

import ast
import sys
from dataclasses import dataclass
from pathlib import Path

from engine.document.state_catalogue import Catalogue
from engine.errors import RegistryError
from engine.state import State

MAX_SOURCE_BYTES = 1_000_000


@dataclass(frozen=True, kw_only=True)
class StateSource:
    """The file of a state class; its class statement is from `line` to `end_line`, which count from 1.

    `file` is relative to the project for a module of the project, absolute for one of an installed package.
    """

    state: str
    module: str
    file: str
    in_project: bool
    line: int
    end_line: int
    text: str


def state_source(catalogue: Catalogue, name: str, *, project: Path) -> StateSource:
    """Return the source of a state that is registered or in a module that the project allows.

    Raises:
        RegistryError: there is no such state, or its source is not a Python file.
    """
    state = catalogue.get(name)
    if state is None:
        raise RegistryError("there is no such state", where=name, hint="see `flexcell states list`")
    file = source_file(state)
    try:
        if file is None or file.stat().st_size > MAX_SOURCE_BYTES:
            raise RegistryError("the source of this state is not a Python file that can be shown", where=name)
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise RegistryError(f"the source of this state cannot be read: {error}", where=name) from error
    line, end_line = _lines_of(text, state.__qualname__)
    inside = file.is_relative_to(project.resolve())
    shown = file.relative_to(project.resolve()).as_posix() if inside else str(file)
    return StateSource(
        state=name, module=state.__module__, file=shown, in_project=inside, line=line, end_line=end_line, text=text
    )


def source_file(state: type[State]) -> Path | None:
    """Return the Python file that defines a state class; None where there is none."""
    module = sys.modules.get(state.__module__)
    file = getattr(module, "__file__", None)
    found = Path(file).resolve() if isinstance(file, str) else None
    return found if found is not None and found.suffix == ".py" and found.is_file() else None


def _lines_of(text: str, qualname: str) -> tuple[int, int]:
    """Return the first and last line of a class statement; the first line of the file if it is not found."""
    try:
        body: list[ast.stmt] = ast.parse(text).body
    except (SyntaxError, ValueError, RecursionError):
        return 1, 1  # being edited; the class that is loaded is an older one
    node: ast.ClassDef | None = None
    for name in qualname.split("."):
        node = next((each for each in body if isinstance(each, ast.ClassDef) and each.name == name), None)
        if node is None:
            return 1, 1
        body = node.body
    return (node.lineno, node.end_lineno or node.lineno) if node is not None else (1, 1)
