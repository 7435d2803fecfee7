"""Lowers steps built in Python to the plain data of a document, with the source location of each."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from engine.authoring.expression_values import Param
from engine.authoring.steps import TreePart
from engine.document.behavior import Behavior
from engine.document.text.yaml_source import MAX_DEPTH, PositionTree
from engine.errors import DocumentError, Position


@dataclass
class Lowering:
    """One document under construction; `file` is its path."""

    file: Path
    references: dict[str, Behavior] = field(default_factory=dict[str, Behavior])
    """The behaviors referred to as objects, by the path written for each."""

    def lower(self, value: object, place: PositionTree, depth: int = 0) -> object:
        """Return plain data for a value that contains steps; their positions are added inside `place`."""
        match value:
            case TreePart():
                _move(place, value.place)
                _require_depth(depth, value.place)
                return self._children(value.keys, place, depth)
            case Param():
                declared = cast("Param[object]", value)
                _move(place, declared.place)
                return dict(declared.keys)
            case Behavior():
                return self._written(value, place)
            case dict():
                return self._children(cast("dict[str, object]", value), place, depth)
            case list():
                items = enumerate(cast("list[object]", value))
                return [self._inside(item, place, index, depth) for index, item in items]
            case _:
                return value

    def _children(self, keys: Mapping[str, object], place: PositionTree, depth: int) -> dict[str, object]:
        return {key: self._inside(item, place, key, depth) for key, item in keys.items()}

    def _inside(self, value: object, place: PositionTree, key: str | int, depth: int) -> object:
        """Lower a nested value; it gets its own position only if that differs from the outer one."""
        inner = PositionTree(place.key_line, place.key_column, place.line, place.column, file=place.file)
        lowered = self.lower(value, inner, depth + 1)
        if isinstance(value, TreePart | Param) or inner.children is not None:
            if place.children is None:
                place.children = {}
            place.children[key] = inner
        return lowered

    def _written(self, target: Behavior, place: PositionTree) -> str:
        """Return the path of another behavior relative to this document."""
        written = Path(os.path.relpath(target.file.resolve(), self.file.resolve().parent)).as_posix()
        known = self.references.setdefault(written, target)
        if known.meaning != target.meaning:
            raise DocumentError(
                f"two different behaviors would both be written as `{written}`",
                where=_position_of(place),
                hint="set another `name` or `file` for one of them",
            )
        return written


def new_source_location(where: Position) -> PositionTree:
    """Return a position tree with value and key at a position."""
    line, column = where.line - 1, where.column - 1
    return PositionTree(line, column, line, column, file=where.file)


def _position_of(place: PositionTree) -> Position:
    return Position(file=place.file or "", line=place.line + 1, column=place.column + 1)


def _move(place: PositionTree, where: Position) -> None:
    place.key_line = place.line = where.line - 1
    place.key_column = place.column = where.column - 1
    place.file = where.file


def _require_depth(depth: int, where: Position) -> None:
    # The strict reader has the same limit; deeper steps could run but not be saved.
    if depth >= MAX_DEPTH:
        message = f"nested deeper than {MAX_DEPTH} levels"
        raise DocumentError(message, where=where, hint="move the inner part into a separate behavior")
