"""Converts an exception and its causes to the chain of causes in events."""

from __future__ import annotations

import traceback

from engine.errors import Cause, CauseLine, FlexcellError
from engine.skill import skill_words


def cause_of(error: BaseException) -> Cause:
    """Return the chain of an error: the error first, then the exceptions that it was raised from."""
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
    """Return the links of a chain in the order of messages: from the root cause outwards."""
    return cause.chain()[::-1] if cause is not None else ()


def describe_cause(cause: Cause) -> str:
    """Return a chain on one line, from the root cause outwards, joined by `so`."""
    return ", so ".join(map(link_text, links_from_root(cause)))


def link_text(link: Cause) -> str:
    """Return the text of one link: the name of a node replaced by its path, the address of a skill by its words."""
    name = link.where.rpartition("/")[2]
    if name and link.message.startswith((f"{name} ended with ", f"{name} was left for ")):
        return f"{link.where}{link.message[len(name) :]}"
    source = skill_words(link.where) or link.where
    return f"{source}: {link.message}" if source else link.message


def cause_line(link: Cause) -> CauseLine:
    """Return one link, without the rest of its chain, as logs show it."""
    return CauseLine(
        message=link.message,
        where=link.where,
        kind=link.kind,
        compared=link.compared,
        skill=skill_words(link.where),
    )


def wrap_cause(message: str, because: Cause | None, *, where: str = "", kind: str = "") -> Cause:
    """Add an outermost link to a chain."""
    return Cause(message=message, where=where, kind=kind, because=because)


def storable_cause(cause: Cause | None) -> Cause | None:
    """Return a chain made by a state in a form that events can store."""
    if cause is None:
        return None
    message, where, kind = (
        escape_surrogates(cause.message),
        escape_surrogates(cause.where),
        escape_surrogates(cause.kind),
    )
    nodes = tuple(map(escape_surrogates, cause.nodes))
    because = storable_cause(cause.because)
    return Cause(message=message, where=where, kind=kind, because=because, nodes=nodes, compared=cause.compared)


def escape_surrogates(text: str) -> str:
    """Return the text with lone surrogates, which UTF-8 cannot encode, written as escapes."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return text.encode(errors="backslashreplace").decode()
    return text


def _raised_at(error: BaseException) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    return f"{frames[-1].filename}:{frames[-1].lineno}" if frames else ""
