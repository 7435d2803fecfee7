"""The text of a document as a tree of spans: start and end of every key, value, comment and line.

The text has passed the strict reader; the spans let a writer preserve each byte it does not change.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol, cast

import msgspec
import yaml

from engine.document.nodes.node_spec import NodeSpec
from engine.document.text.yaml_source import SURROGATE_PAIR, StrictReader
from engine.errors import DocumentError, Position

_VALUES = (yaml.ScalarEvent, yaml.MappingStartEvent, yaml.SequenceStartEvent)
_ENDS = (yaml.MappingEndEvent, yaml.SequenceEndEvent)
_LOST = 2
"""Number of characters by which two `\\uXXXX` of JSON are longer than the `\\UXXXXXXXX` of YAML."""


class Scalar(msgspec.Struct, eq=False, gc=False, tag=True):
    """One scalar value; `style` is its quote, `|`, `>` or empty for plain text."""

    start: int
    end: int
    value: object
    style: str

    def move(self, by: int) -> None:
        """Move it by a number of characters."""
        self.start += by
        self.end += by


class Member(msgspec.Struct, eq=False, gc=False):
    """One entry of a mapping or item of a list, with the lines and comments that belong to it.

    In a block collection, `start` is the start of its lines (including blank lines and comments above it) and `stop`
    the end of its last line; in a flow collection, both are those of the entry itself. `at` is the position
    of its key or dash.
    """

    start: int
    at: int
    key: Scalar | None
    value: Syntax
    stop: int

    def move(self, by: int) -> None:
        """Move its lines and its key, but not its value."""
        self.start += by
        self.at += by
        self.stop += by
        if self.key is not None:
            self.key.move(by)


class Collection(msgspec.Struct, eq=False, gc=False, tag=True):
    """A mapping or list; `data` is the plain dict or list parsed from it, `column` the column of its members.

    Positions inside it move only when they are read: until then they are `behind` by a number of characters.
    """

    origin: SourceText
    start: int
    end: int
    flow: bool
    column: int
    data: dict[str, object] | list[object]
    entries: list[Member] = []
    behind: int = 0
    read: Content | None = None
    node: NodeSpec | None = None
    """The node that its text describes, once it was decoded."""

    @property
    def members(self) -> list[Member]:
        """Its entries, with their positions in the text."""
        by = self.behind
        if by:
            self.behind = 0
            for member in self.entries:
                member.move(by)
                member.value.move(by)
        return self.entries

    @property
    def content(self) -> Content:
        """What its text says, which stays the same."""
        if self.read is None:
            self.read = _content_of(self)
        return self.read

    def move(self, by: int) -> None:
        """Move it with everything inside it."""
        self.start += by
        self.end += by
        self.behind += by

    @property
    def bare(self) -> bool:
        """True for the pair in `[key: value]`, a mapping without braces."""
        return self.flow and self.origin.text[self.start] not in "{["


Syntax = Scalar | Collection


class Content(msgspec.Struct, frozen=True, gc=False):
    """What the text of a collection says, whatever its data has become.

    `values` are scalars, and the data of the collections that are `inside`. `nodes`, `expressions` and
    `expression_text` count everything in it as the limits of a document do.
    """

    keys: tuple[object, ...]
    values: tuple[object, ...]
    inside: tuple[Collection, ...]
    nodes: int
    expressions: int
    expression_text: int


def _content_of(found: Collection) -> Content:
    keys = tuple(member.key.value for member in found.entries if member.key is not None)
    values = tuple(
        each.value.data if isinstance(each.value, Collection) else each.value.value for each in found.entries
    )
    inside = tuple(member.value for member in found.entries if isinstance(member.value, Collection))
    texts = [value for value in values if isinstance(value, str) and "${" in value]
    return Content(
        keys,
        values,
        inside,
        nodes=1 + len(keys) + len(values) - len(inside) + sum(each.content.nodes for each in inside),
        expressions=sum(text.count("${") for text in texts) + sum(each.content.expressions for each in inside),
        expression_text=sum(map(len, texts)) + sum(each.content.expression_text for each in inside),
    )


@dataclass(slots=True, eq=False, weakref_slot=True)
class SourceText:
    """A text that was read. It has no reference to its tree, so that the tree is freed when no one uses it."""

    text: str
    json: bool

    def indent_at(self, offset: int) -> int:
        """Return the indentation of the line that contains `offset`."""
        start = self.text.rfind("\n", 0, offset) + 1
        return len(self.text) - start - len(self.text[start:].lstrip(" ")) if start < len(self.text) else 0


@dataclass(frozen=True, slots=True, eq=False)
class SyntaxTree:
    """A text and its outermost value."""

    origin: SourceText
    root: Syntax

    def collections(self) -> Iterator[Collection]:
        """Iterate over every collection, outer ones first."""
        due: list[Syntax] = [self.root]
        while due:
            found = due.pop()
            if isinstance(found, Collection):
                yield found
                due += [member.value for member in found.entries]


class _Mark(Protocol):
    index: int
    column: int


class _Event(Protocol):
    start_mark: _Mark
    end_mark: _Mark
    value: str
    style: str | None
    flow_style: bool


def read_syntax(text: str, *, file: str) -> SyntaxTree:
    """Read YAML or JSON text with lines that end in a line feed.

    Raises:
        DocumentError: the strict reader rejects it, or it is not a mapping; `where` is the position.
    """
    origin = SourceText(text, file.endswith(".json"))
    reading = StrictReader(text, file=file, places=False)
    found = _Reader(origin, reading).read()
    if not isinstance(reading.source().data, dict) or found is None:
        where = Position(file=file, line=1, column=1)
        raise DocumentError("the document is not a mapping", where=where, hint="begin it with `flexcell: 1`")
    # A `.json` file may contain YAML, which the reader accepts: then it is treated as YAML.
    origin.json = origin.json and isinstance(found, Collection) and found.flow
    return SyntaxTree(origin, found)


def read_entries(origin: SourceText, start: int, end: int, column: int, file: str) -> list[Member]:
    """Read lines of a text alone, which are entries of a block mapping at `column`; none if they are anything else.

    Raises:
        DocumentError: the strict reader rejects them; the position is one in these lines.
    """
    found = _Reader(origin, StrictReader(origin.text[start:end], file=file, places=False), start).read()
    fits = isinstance(found, Collection) and isinstance(found.data, dict) and not found.flow and found.column == column
    return cast("Collection", found).members if fits else []


class _Reader:
    def __init__(self, origin: SourceText, reading: StrictReader, start: int = 0) -> None:
        self._origin = origin
        self._text = origin.text
        self._from = start
        self._reading = reading
        # PyYAML is untyped: the cast contains it here.
        self._events = cast("Iterator[_Event]", iter(reading))
        self._next = self._events.__next__
        pairs = SURROGATE_PAIR.finditer(self._text) if origin.json else ()
        # The parsed text may be shorter than the original one.
        self._shorter = [pair.end() - _LOST * (number + 1) for number, pair in enumerate(pairs)]

    def _span(self, event: _Event) -> tuple[int, int]:
        """Return start and end of an event in the original text."""
        start, end = event.start_mark.index, event.end_mark.index
        if not self._shorter:
            return self._from + start, self._from + end
        return start + _LOST * bisect_right(self._shorter, start), end + _LOST * bisect_right(self._shorter, end)

    def read(self) -> Syntax | None:
        """Read the whole text and return its outermost value; None if it is empty."""
        found: Syntax | None = None
        for event in self._events:
            if found is None and cast("type", type(event)) in _VALUES:
                found = self._value(event, 0)
        return found

    def _value(self, event: _Event, outside: int) -> Syntax:
        """Read a value; `outside` is the end of its key or dash, for omitted values."""
        kind = cast("type", type(event))
        if kind is yaml.ScalarEvent:
            return self._scalar(event, outside)
        mapping = kind is yaml.MappingStartEvent
        start = self._span(event)[0]
        if not event.flow_style:
            start = block_start(self._text, start, event.start_mark.column)
        data = cast("dict[str, object] | list[object]", self._reading.latest)
        made = Collection(self._origin, start, start, event.flow_style, event.start_mark.column, data)
        while True:
            event = self._next()
            if cast("type", type(event)) in _ENDS:
                break
            previous = made.members[-1].stop if made.members else made.start
            made.members.append(self._entry(event, made, previous) if mapping else self._item(event, made, previous))
        if made.flow:
            made.end = max(self._span(event)[1], made.members[-1].stop if made.members else 0)
        elif made.members:
            made.end = made.members[-1].stop
        return made

    def _entry(self, event: _Event, made: Collection, previous: int) -> Member:
        key = Scalar(*self._span(event), event.value, event.style or "")
        value = self._value(self._next(), key.end)
        at = self._explicit(key.start, previous)
        return self._placed(made, previous, at, key, value)

    def _item(self, event: _Event, made: Collection, previous: int) -> Member:
        if made.flow:
            value = self._value(event, previous)
            at = value.start
        else:
            at = skip_space(self._text, previous)
            value = self._value(event, at + 1)
        return self._placed(made, previous, at, None, value)

    def _placed(self, made: Collection, previous: int, at: int, key: Scalar | None, value: Syntax) -> Member:
        if made.flow:
            return Member(at, at, key, value, max(value.end, key.end if key is not None else 0))
        start = previous if not made.members else min(previous + 1, at)
        return Member(start, at, key, value, last_line(self._text, max(value.end, at + 1), made.column))

    def _scalar(self, event: _Event, outside: int) -> Scalar:
        (start, end), style = self._span(event), event.style or ""
        if start == end:
            # An omitted value: its position is after the colon, if there is one.
            colon = skip_space(self._text, outside)
            start = end = colon + 1 if self._text[colon : colon + 1] == ":" else outside
        elif style in ("|", ">"):
            kept = "+" in self._text[start : self._text.find("\n", start)]
            shown = self._text[start:end]
            end = start + len(shown[:-1] if kept and shown.endswith("\n") else shown.rstrip("\n"))
        return Scalar(start, end, self._reading.latest, style)

    def _explicit(self, at: int, previous: int) -> int:
        """Return the position of a `? ` before a key, else of the key."""
        before = self._text[previous:at].rstrip(" ")
        return previous + len(before) - 1 if before.endswith("?") else at


def block_start(text: str, start: int, column: int) -> int:
    """Return the start of the comments directly above the first member of a block, which is at `start`."""
    line = text.rfind("\n", 0, start) + 1
    if text[line:start].strip(" "):
        return start
    while line > 0:
        above = text.rfind("\n", 0, line - 1) + 1
        if not text.startswith(f"{' ' * column}#", above):
            break
        line, start = above, above + column
    return start


def last_line(text: str, end: int, column: int) -> int:
    """Return the end of the line at `end`, or of the last comment below it indented deeper than `column`."""
    stop = _line_end(text, end)
    at = stop
    while at < len(text):
        line_end = _line_end(text, at + 1)
        line = text[at + 1 : line_end]
        bare = line.lstrip(" ")
        if bare.startswith("#") and len(line) - len(bare) > column:
            stop = line_end
        elif bare.strip():
            break
        at = line_end
    return stop


def skip_space(text: str, at: int) -> int:
    """Return the first position from `at` on that is not space, line end, comma or comment."""
    while at < len(text):
        if text[at] in " \t\n\r,":
            at += 1
        elif text[at] == "#" and (at == 0 or text[at - 1] in " \t\n\r,"):
            at = _line_end(text, at)
        else:
            break
    return at


def _line_end(text: str, at: int) -> int:
    found = text.find("\n", at)
    return found if found >= 0 else len(text)
