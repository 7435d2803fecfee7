"""Mistakes of YAML syntax: what the parser complains of, in words that say what to do."""

from __future__ import annotations

from typing import Protocol, cast

import yaml

from engine.errors import DocumentError, Position

_OPENING = ("while parsing a flow", "while scanning a quoted scalar")
# What libyaml says, and what it means to whoever wrote the document, with what to do.
_IN_OUR_WORDS = {
    "did not find expected node content": (
        "a value is missing before this place",
        "close what is open with `]` or `}`, or put the text in quotes",
    ),
    "did not find expected ',' or ']'": ("unmatched bracket", "close it with `]`, or put the text in quotes"),
    "did not find expected key": (
        "no key is here, where one must be",
        "compare the indentation with the lines above, and close what is open there",
    ),
    "did not find expected '-' indicator": (
        "no `-` is here, where the list goes on",
        "compare the indentation with the items above",
    ),
    "could not find expected ':'": ("a `:` is missing after a key", "write `key: value`"),
    "found character that cannot start any token": ("no value can begin with this character", "put the text in quotes"),
    "found unexpected end of stream": ("unexpected end of the document in a text", "close the quotes"),
    "block sequence entries are not allowed in this context": (
        "a list begins beside something else",
        "begin it on a line of its own",
    ),
}


class TextMark(Protocol):
    """A place in a text, from 0."""

    line: int
    column: int


class LineMistake(DocumentError):
    """A mistake in the block that begins on `line`, from 0; the text may be readable without it."""

    line: int = 0


def syntax_error(error: yaml.MarkedYAMLError, file: str, text: str) -> LineMistake:
    """Return the mistake that the parser of PyYAML found in a text."""
    mark = cast("TextMark | None", error.problem_mark or error.context_mark)
    line, column = (mark.line, mark.column) if mark is not None else (0, 0)
    lines = text.split("\n", line + 1)
    here = lines[line][column : column + 1] if line < len(lines) else ""
    message, hint = error.problem or "this is not YAML", error.context
    if here == "\t":
        message, hint = "YAML requires spaces here, not a tab", "indent with spaces"
    elif here in ("{", "}") or "expected ',' or '}'" in message:
        message, hint = "unmatched brace", "put text with `${…}` in quotes"
    elif "mapping values are not allowed" in message:
        message, hint = "a second `:` on this line", "put the text in quotes"
    else:
        message, hint = _IN_OUR_WORDS.get(message, (message, hint))
    refusal = LineMistake(message, where=Position(file=file, line=line + 1, column=column + 1), hint=hint)
    # An unclosed block is detected only where another one begins.
    begins = error.context_mark if (error.context or "").startswith(_OPENING) else None
    refusal.line = begins.line if begins is not None else line
    return refusal
