"""Recovers a text with invalid YAML: each invalid block is removed and reported."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from engine.document.text.syntax_errors import LineMistake
from engine.document.text.yaml_source import (
    DataPath,
    DocumentSource,
    PositionTree,
    load_text,
    parse_source,
)
from engine.errors import DocumentError

_MOST_BLOCKS = 20
_MOST_WORK = 2_000_000
"""Maximum total number of characters parsed again: 20 passes over 100 kB, one over 2 MB."""


@dataclass(frozen=True, kw_only=True)
class RecoveredText:
    """The rest of a text (None if empty), its mistakes, and the containers of the removed blocks."""

    source: DocumentSource | None
    mistakes: tuple[DocumentError, ...] = ()
    gaps: tuple[DataPath, ...] = ()


def load_recovering(path: Path) -> RecoveredText:
    """Read a file without its unreadable lines.

    Raises:
        DocumentError: it is not text, or too large.
    """
    return recover_text(load_text(path), file=str(path))


def recover_text(content: bytes | str, *, file: str) -> RecoveredText:
    """Read a text without its unreadable lines."""
    mistakes: list[DocumentError] = []
    blocks: list[tuple[int, int]] = []
    text, work = content, 0
    while True:
        try:
            source = parse_source(text, file=file)
        except LineMistake as mistake:
            mistakes.append(mistake)
            lines = (text.decode() if isinstance(text, bytes) else text).split("\n")
            work += len(text)
            first = _written(lines, mistake.line)
            if first is None or len(mistakes) >= _MOST_BLOCKS or work > _MOST_WORK or file.endswith(".json"):
                return RecoveredText(source=None, mistakes=tuple(mistakes))
            blocks.append(_blank(lines, first))
            text = "\n".join(lines)
        except DocumentError as error:
            # If nothing else is left, the removed blocks are the only mistakes.
            return RecoveredText(source=None, mistakes=tuple(mistakes or [error]))
        else:
            gaps = tuple(_around(source.place, *block) for block in blocks)
            return RecoveredText(source=source, mistakes=tuple(mistakes), gaps=gaps)


def _written(lines: list[str], line: int) -> int | None:
    """Return the line of a mistake; one detected at the end belongs to the last non-empty line."""
    return next((number for number in range(min(line, len(lines) - 1), -1, -1) if lines[number].strip()), None)


def _blank(lines: list[str], first: int) -> tuple[int, int]:
    """Blank a line and the lines indented below it; return its number and its indentation."""
    indent, last = _indent(lines[first]), first
    while last + 1 < len(lines) and (not lines[last + 1].strip() or _indent(lines[last + 1]) > indent):
        last += 1
    lines[first : last + 1] = [""] * (last + 1 - first)
    return first, indent


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


def _around(place: PositionTree, line: int, indent: int) -> DataPath:
    """Return the innermost mapping or list that contained a block at this line and indentation."""
    path: DataPath = ()
    while place.children:
        before = [(key, inner) for key, inner in place.children.items() if inner.key_line < line]
        if not before or before[-1][1].key_column >= indent:
            break
        key, place = before[-1]
        path = (*path, key)
    return path
