"""Writes behaviors as YAML: readable, without defaults, deterministic."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import msgspec

from engine.document.behavior import Behavior
from engine.document.loader import load_behavior, parse_behavior
from engine.document.nodes.node_spec import NodeSpec
from engine.document.text.yaml_writer import write_yaml
from engine.errors import DocumentError

_FIRST = ("name", "description")


def to_yaml(behavior: Behavior) -> str:
    """Return the YAML document of a behavior, built in Python or read from a file; comments are not kept."""
    data = cast("dict[str, object]", msgspec.to_builtins(behavior.document))
    _order(behavior.root, cast("dict[str, object]", data["root"]))
    return write_yaml(data)


def write_behavior(behavior: Behavior, file: Path) -> tuple[Path, ...]:
    """Write a behavior and the Python-built behaviors that it refers to; return the files written.

    Raises:
        DocumentError: the document would not read back as the same behavior, usually because a
            referenced file is missing at its path; `file` is not replaced.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    for path, target in behavior.references.items():
        place = file.parent / path
        if _holds(place, target):
            continue
        if not is_made_in_python(target) or not _is_below(place, file.parent):
            raise DocumentError(
                f"{file.name} refers to `{path}`, which does not exist",
                where=place,
                hint=f"write {file.name} in {behavior.file.parent}, or write that behavior first",
            )
        written += write_behavior(target, place)
    text = to_yaml(behavior)
    if parse_behavior(text, file=file).meaning != behavior.meaning:
        raise DocumentError(
            "the document would not have the same semantics", where=file, hint="this is a bug in flexcell; report it"
        )
    _replace(file, text)
    return (*written, file)


def is_made_in_python(behavior: Behavior) -> bool:
    """Return whether a behavior was built in Python, not read from a document."""
    return Path(behavior.source.file) != behavior.file


def _order(node: NodeSpec, data: dict[str, object]) -> None:
    """Order name and description of a node and of all nodes inside before long values."""
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
    """Return whether a file already contains the same behavior."""
    try:
        return file.is_file() and load_behavior(file).meaning == target.meaning
    except DocumentError:
        return False  # the existing content is replaced


def _is_below(file: Path, folder: Path) -> bool:
    return file.resolve().is_relative_to(folder.resolve())


def _replace(file: Path, text: str) -> None:
    """Write a file atomically: a reader sees the old or the new content."""
    part = file.with_name(f"{file.name}.part")
    part.write_text(text, encoding="utf-8", newline="\n")
    part.replace(file)
