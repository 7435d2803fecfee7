"""Source location of a node in the user's Python file, for errors, findings and logs."""

from __future__ import annotations

import inspect
from functools import lru_cache
from types import CodeType, FrameType

from engine.errors import Position

_PACKAGE = __name__.rpartition(".")[0]


def calling_position() -> Position:
    """Return the position of the nearest caller outside this package."""
    frame = inspect.currentframe()
    while frame is not None and _is_ours(frame):
        frame = frame.f_back
    if frame is None:
        return Position(file="<python>", line=1, column=1)
    # Only the instruction table has the column, and the first line of a multi-line call.
    line, column = _instructions(frame.f_code)[frame.f_lasti // 2]
    return Position(file=frame.f_code.co_filename, line=line or frame.f_lineno, column=(column or 0) + 1)


def _is_ours(frame: FrameType) -> bool:
    module = str(frame.f_globals.get("__name__", ""))
    return module == _PACKAGE or module.startswith(f"{_PACKAGE}.")


@lru_cache(maxsize=64)
def _instructions(code: CodeType) -> tuple[tuple[int | None, int | None], ...]:
    return tuple((line, column) for line, _, column, _ in code.co_positions())
