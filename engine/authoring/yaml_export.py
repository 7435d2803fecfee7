"""Writes behaviors as YAML: readable, without defaults, the same bytes each time."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import msgspec

from engine.document.behavior import Behavior
from engine.document.loader import load_behavior, parse_behavior
from engine.document.node_spec import NodeSpec
from engine.document.yaml_writer import write_yaml
from engine.errors import DocumentError

_FIRST = ("name", "description")


def to_yaml(behavior: Behavior) -> str:
    """Return the YAML document of a behavior, made in Python or read from a file; comments are not kept."""
    data = cast("dict[str, object]", msgspec.to_builtins(behavior.document))
    _order(behavior.root, cast("dict[str, object]", data["root"]))
    return write_yaml(data)


def write_behavior(behavior: Behavior, file: Path) -> tuple[Path, ...]:
    """Write a behavior, and those made in Python that it refers to, and return the files written.

    Raises:
        DocumentError: what was written would not read back as the same behavior, usually because
            a file that it refers to is not where the document looks for it; nothing replaces `file`.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    for path, target in behavior.references.items():
        place = file.parent / path
        if _holds(place, target):
            continue
        if not is_made_in_python(target) or not _is_below(place, file.parent):
            raise DocumentError(
                f"{file.name} refers to `{path}`, which is not there",
                where=place,
                hint=f"write it beside {behavior.file.name} in {behavior.file.parent}, or write that behavior first",
            )
        written += write_behavior(target, place)
    text = to_yaml(behavior)
    if parse_behavior(text, file=file).meaning != behavior.meaning:
        raise DocumentError("the document would not mean the same", where=file, hint="this is a fault of flexcell")
    _replace(file, text)
    return (*written, file)


def is_made_in_python(behavior: Behavior) -> bool:
    """Tell a behavior made in Python from one that was read from a document."""
    return Path(behavior.source.file) != behavior.file


def _order(node: NodeSpec, data: dict[str, object]) -> None:
    """Put name and description of a node before what may be long, here and in all nodes inside."""
    for name, child in node.children.items():
        _order(child, _value_at(data, node.child_keys(name)))
    rest = dict(data)
    data.clear()
    data.update({key: rest.pop(key) for key in _FIRST if key in rest})
    data.update(rest)


def _value_at(data: dict[str, object], keys: tuple[str | int, ...]) -> dict[str, object]:
    value: Any = data
    for key in keys:
        value = value[key]
    return cast("dict[str, object]", value)


def _holds(file: Path, target: Behavior) -> bool:
    """Tell whether a file already says the same."""
    try:
        return file.is_file() and load_behavior(file).meaning == target.meaning
    except DocumentError:
        return False  # whatever stands there is to be replaced


def _is_below(file: Path, folder: Path) -> bool:
    return file.resolve().is_relative_to(folder.resolve())


def _replace(file: Path, text: str) -> None:
    """Write a file so that a reader sees the old or the new one, never a part."""
    part = file.with_name(f"{file.name}.part")
    part.write_text(text, encoding="utf-8", newline="\n")
    part.replace(file)
