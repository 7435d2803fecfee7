"""Turns an exception with everything that caused it into the chain of causes that events carry."""

from __future__ import annotations

import traceback

from engine.errors import FlexcellError
from engine.event import Cause


def cause_of(error: BaseException) -> Cause:
    """Return the chain: this error first, what it was raised from below it."""
    below = error.__cause__
    because = cause_of(below) if below is not None else None
    if isinstance(error, FlexcellError):
        hint = f" ({error.hint})" if error.hint else ""
        where = str(error.where) if error.where is not None else ""
        kind = type(error).__name__
        return Cause(message=error.message + hint, where=where, kind=kind, because=because, nodes=error.nodes)
    text = str(error) or type(error).__name__
    return Cause(message=text, where=_raised_at(error), kind=type(error).__name__, because=because)


def describe(cause: Cause) -> str:
    """Write a chain on one line, outermost first, joined by `because`."""
    return " because ".join(_link(link) for link in cause.chain())


def under(message: str, because: Cause | None, *, where: str = "", kind: str = "") -> Cause:
    """Put a new outermost link on top of a chain."""
    return Cause(message=message, where=where, kind=kind, because=because)


def _link(cause: Cause) -> str:
    return f"{cause.where}: {cause.message}" if cause.where else cause.message


def _raised_at(error: BaseException) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    return f"{frames[-1].filename}:{frames[-1].lineno}" if frames else ""
