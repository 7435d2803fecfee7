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
        message = escape_surrogates(error.message + hint)
        return Cause(message=message, where=escape_surrogates(where), kind=kind, because=because, nodes=error.nodes)
    text = escape_surrogates(str(error)) or type(error).__name__
    return Cause(message=text, where=_raised_at(error), kind=type(error).__name__, because=because)


def links_from_root(cause: Cause | None) -> tuple[Cause, ...]:
    """Return the links of a chain as people are told them: what was measured first, then what followed from it."""
    return cause.chain()[::-1] if cause is not None else ()


def describe_cause(cause: Cause) -> str:
    """Write a chain on one line, from what was measured outwards, joined by `so`."""
    return ", so ".join(map(link_text, links_from_root(cause)))


def link_text(link: Cause) -> str:
    """Write one link: what is said of a node by its name is said by its path."""
    name = link.where.rpartition("/")[2]
    if name and link.message.startswith((f"{name} ended with ", f"{name} was left for ")):
        return f"{link.where}{link.message[len(name) :]}"
    return f"{link.where}: {link.message}" if link.where else link.message


def wrap_cause(message: str, because: Cause | None, *, where: str = "", kind: str = "") -> Cause:
    """Put a new outermost link on top of a chain."""
    return Cause(message=message, where=where, kind=kind, because=because)


def storable_cause(cause: Cause | None) -> Cause | None:
    """Return a chain that a state has made, as events can keep it."""
    if cause is None:
        return None
    message, where, kind = (
        escape_surrogates(cause.message),
        escape_surrogates(cause.where),
        escape_surrogates(cause.kind),
    )
    nodes = tuple(map(escape_surrogates, cause.nodes))
    return Cause(message=message, where=where, kind=kind, because=storable_cause(cause.because), nodes=nodes)


def escape_surrogates(text: str) -> str:
    """Return text in which halves of characters (lone surrogates, which no UTF-8 holds) are written out."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return text.encode(errors="backslashreplace").decode()
    return text


def _raised_at(error: BaseException) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    return f"{frames[-1].filename}:{frames[-1].lineno}" if frames else ""
