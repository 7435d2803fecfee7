"""The indentation of lines of YAML text."""

from __future__ import annotations


def indent_text(text: str, by: int, *, first: bool = False) -> str:
    """Return text indented by a number of columns; the first line only if `first`."""
    if by == 0:
        return text
    lines = text.split("\n")
    return "\n".join(_moved(line, by) if number or first else line for number, line in enumerate(lines))


def indent_after(gap: str, otherwise: int) -> int:
    """Return the columns by which the last line of the text between two values is indented; otherwise, of none."""
    last = gap.rpartition("\n")
    return len(last[2]) - len(last[2].lstrip(" ")) if last[1] else otherwise


def _moved(line: str, by: int) -> str:
    if not line.strip():
        return line
    if by > 0:
        return " " * by + line
    bare = line.lstrip(" ")
    return " " * max(0, len(line) - len(bare) + by) + bare
