"""Strict YAML 1.2 and JSON text to plain data, with the line and column of every key and value.

Accepted is the part of YAML 1.2 that every parser reads equally: one UTF-8 document of
mappings, sequences and scalars of the core schema. Anchors, aliases, tags, merge keys, duplicate
keys, integers beyond 64 bits and numbers that are not finite are refused, as is text that is too
large or nested too deeply. Keys are always text. The parser's event stream is processed without
recursion, so the cost of hostile text is linear in its size.
"""

from __future__ import annotations

import re
import stat
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn, Protocol, cast

import msgspec
import yaml

from engine.document.text.chunked_text import ChunkedText
from engine.document.text.core_schema import plain_scalar, shorten_scalar
from engine.errors import DocumentError, Position
from engine.wording.misfit import DataPath

MAX_BYTES = 2_000_000
MAX_DEPTH = 64
MAX_NODES = 200_000
MAX_EXPRESSIONS = 20_000
MAX_EXPRESSION_TEXT = 100_000
"""Maximum total number of characters of texts with expressions."""

_OPENING = ("while parsing a flow", "while scanning a quoted scalar")
# A positive class, as a complement takes ten times as long to compile.
_UNREADABLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]")
SURROGATE_PAIR = re.compile(r"(?<!\\)((?:\\\\)*)\\u([dD][89abAB][0-9a-fA-F]{2})\\u([dD][c-fC-F][0-9a-fA-F]{2})")


class PositionTree(msgspec.Struct, gc=False):
    """Position of a key and its value, from 0, and the positions inside the value."""

    key_line: int
    key_column: int
    line: int
    column: int
    children: dict[str | int, PositionTree] | None = None
    file: str | None = None
    """Its file, if it differs from the document's."""


@dataclass(frozen=True, kw_only=True)
class DocumentSource:
    """A parsed document: plain data and the position of each part in `file`."""

    file: str
    data: object
    place: PositionTree = field(repr=False)

    def position(self, path: DataPath, *, of_key: bool = False) -> Position:
        """Return the position of the value (or the key) at `path`, or of its nearest existing ancestor."""
        place = self.place
        for step in path:
            child = place.children.get(step) if place.children is not None else None
            if child is None:
                of_key = True
                break
            place = child
        file = place.file or self.file
        if of_key:
            return Position(file=file, line=place.key_line + 1, column=place.key_column + 1)
        return Position(file=file, line=place.line + 1, column=place.column + 1)


class LineMistake(DocumentError):
    """A mistake in the block that begins on `line`, from 0; the text may be readable without it."""

    line: int = 0


def load_source(path: Path) -> DocumentSource:
    """Read a YAML or JSON file.

    Raises:
        DocumentError: the file cannot be read or is not an acceptable document; `where` is the position.
    """
    return parse_source(load_text(path), file=str(path))


def load_text(path: Path) -> bytes:
    """Read a file up to the maximum document size.

    Raises:
        DocumentError: it cannot be read; `where` is its start.
    """
    start = Position(file=str(path), line=1, column=1)
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise DocumentError("this is not a file", where=start, hint="use the path of a YAML or JSON file")
        with path.open("rb") as stream:
            return stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise DocumentError(f"cannot read this file: {reason}", where=start, hint="check its path") from error


def parse_source(content: bytes | str, *, file: str) -> DocumentSource:
    """Parse YAML or JSON text; `file` is the name to show in positions.

    Raises:
        DocumentError: the text is not an acceptable document; `where` is the position.
    """
    reading = StrictReader(content, file=file)
    for _ in reading:
        pass
    return reading.source()


class StrictReader:
    """Reads a text event by event, for callers that need more than its data: iterate, then read `source`.

    `latest` is the value that the last event completed or started. Iterating raises the errors of `parse_source`.
    Without `places` the source has no positions of list items, which take as much memory as their values.
    """

    def __init__(self, content: bytes | str, *, file: str, places: bool = True) -> None:
        self._text = _acceptable(content, file)
        self._file = file
        self._builder = _Builder(file, places=places)

    @property
    def latest(self) -> object:
        """The last scalar, or the dict or list that was started."""
        return self._builder.latest

    def source(self) -> DocumentSource:
        """Return the document after the iteration is complete."""
        return self._builder.source()

    def __iter__(self) -> Iterator[object]:
        return _events(self._text, self._file, self._builder)


def _acceptable(content: bytes | str, file: str) -> str:
    text = _decode(content, file) if isinstance(content, bytes) else content
    if len(text) > MAX_BYTES:
        raise _too_large(file)
    if text.startswith("\ufeff"):
        _refuse(file, 0, 0, "the file starts with a byte order mark", "save it as UTF-8 without BOM")
    unreadable = _UNREADABLE.search(text)
    if unreadable:
        line, column = _line_and_column(text, unreadable.start())
        shown = f"U+{ord(unreadable.group()):04X}"
        _refuse(file, line, column, f"the character {shown} is not allowed in a document", "remove or escape it")
    if file.endswith(".json"):
        text = SURROGATE_PAIR.sub(one_code_point, text)
    return text


def _decode(content: bytes, file: str) -> str:
    if len(content) > MAX_BYTES:
        raise _too_large(file)
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        _refuse(file, 0, 0, "the file is UTF-16", "save it as UTF-8")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        before = content[: error.start].decode("utf-8")
        line, column = _line_and_column(before, len(before))
        byte = content[error.start]
        position = Position(file=file, line=line + 1, column=column + 1)
        raise DocumentError(f"byte 0x{byte:02x} is not UTF-8", where=position, hint="save it as UTF-8") from error


def one_code_point(pair: re.Match[str]) -> str:
    """Join the surrogate pair of a JSON escape to one YAML escape."""
    backslashes, high, low = pair.groups()
    code = 0x10000 + ((int(high, 16) - 0xD800) << 10) + (int(low, 16) - 0xDC00)
    return f"{backslashes}\\U{code:08x}"


def _line_and_column(text: str, index: int) -> tuple[int, int]:
    line = text.count("\n", 0, index)
    return line, index - (text.rfind("\n", 0, index) + 1)


def _too_large(file: str) -> DocumentError:
    limit = f"{MAX_BYTES / 1e6:g} MB"
    where = Position(file=file, line=1, column=1)
    return DocumentError(f"the file is larger than {limit}", where=where, hint="split it with behavior references")


def _refuse(file: str, line: int, column: int, message: str, hint: str | None = None) -> NoReturn:
    raise DocumentError(message, where=Position(file=file, line=line + 1, column=column + 1), hint=hint)


class _Mark(Protocol):
    line: int
    column: int


class _Event(Protocol):
    """The members of PyYAML's parser events that are used here."""

    start_mark: _Mark
    anchor: str | None
    tag: str | None
    value: str
    implicit: tuple[bool, bool]
    version: tuple[int, int] | None
    tags: dict[str, str] | None


def _events(text: str, file: str, builder: _Builder) -> Iterator[object]:
    # PyYAML's C parser is untyped: the cast contains it here.
    parser = yaml.CSafeLoader(ChunkedText(text))
    next_event = cast("Callable[[], _Event | None]", parser.get_event)
    try:
        while (event := next_event()) is not None:
            ended = builder.take(event)
            yield event
            if ended:
                break
    except yaml.MarkedYAMLError as error:
        # In no variable here, which would keep this frame and those of all callers in memory.
        raise _syntax_error(error, file, text) from None
    except yaml.YAMLError as error:
        raise DocumentError(str(error).splitlines()[0], where=Position(file=file, line=1, column=1)) from None
    finally:
        parser.dispose()


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


def _syntax_error(error: yaml.MarkedYAMLError, file: str, text: str) -> LineMistake:
    mark = cast("_Mark | None", error.problem_mark or error.context_mark)
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


class _Builder:
    """Builds data and positions from parser events, with a stack instead of recursion."""

    def __init__(self, file: str, *, places: bool) -> None:
        self._file = file
        self._places = places
        self._documents = 0
        self._nodes = 0
        self._expressions = 0
        self._expression_text = 0
        self.latest: object = None
        self._root: list[object] = []
        self._root_place = PositionTree(0, 0, 0, 0)
        # One row per open container: the container, its position, and the pending key of a mapping.
        self._container: dict[str, object] | list[object] | None = None
        self._place = self._root_place
        self._key: tuple[str, int, int] | None = None
        self._stack: list[
            tuple[dict[str, object] | list[object] | None, PositionTree, tuple[str, int, int] | None]
        ] = []

    def take(self, event: _Event) -> bool:
        """Process one event; return True at the end of the stream."""
        kind = cast("object", type(event))
        if kind is yaml.ScalarEvent:
            self._scalar(event)
        elif kind is yaml.MappingStartEvent:
            self._open(event, {})
        elif kind is yaml.SequenceStartEvent:
            self._open(event, [])
        elif kind is yaml.MappingEndEvent or kind is yaml.SequenceEndEvent:
            self._container, self._place, self._key = self._stack.pop()
        elif kind is yaml.AliasEvent:
            self._refuse_line(event, f"the alias `*{event.anchor}` is not supported", "write the value in full")
        elif kind is yaml.DocumentStartEvent:
            self._start_document(event)
        return kind is yaml.StreamEndEvent

    def source(self) -> DocumentSource:
        """Return the built document."""
        if not self._root:
            _refuse(self._file, 0, 0, "the document is empty")
        return DocumentSource(file=self._file, data=self._root[0], place=self._root_place)

    def _start_document(self, event: _Event) -> None:
        self._documents += 1
        if self._documents > 1:
            self._refuse(event, "a second document starts here", "one file holds one document: remove `---`")
        if event.version is not None and tuple(event.version) != (1, 2):
            self._refuse(event, f"this is YAML {event.version[0]}.{event.version[1]}", "documents are YAML 1.2")
        if event.tags:
            self._refuse(event, "`%TAG` is not supported")

    def _count(self, event: _Event) -> _Mark:
        self._nodes += 1
        if self._nodes > MAX_NODES:
            self._refuse(event, f"the document has more than {MAX_NODES} values", "split it with behavior references")
        if event.anchor is not None:
            self._refuse_line(
                event, f"the anchor `&{event.anchor}` is not supported", "write the value in full where it is used"
            )
        if event.tag is not None:
            self._refuse_line(event, f"the tag `{event.tag}` is not supported", "remove it")
        return event.start_mark

    def _scalar(self, event: _Event) -> None:
        mark = self._count(event)
        value = event.value
        plain = event.implicit[0]
        container = self._container
        if type(container) is dict and self._key is None:
            self._take_key(event, value, plain=plain)
            return
        if "${" in value:
            self._count_expressions(event, value)
        resolved = self.latest = self._resolve(event, value) if plain else value
        self._add(resolved, mark.line, mark.column)

    def _count_expressions(self, event: _Event, value: str) -> None:
        self._expressions += value.count("${")
        self._expression_text += len(value)
        hint = "split it with behavior references"
        if self._expressions > MAX_EXPRESSIONS:
            self._refuse(event, f"the document has more than {MAX_EXPRESSIONS} expressions", hint)
        if self._expression_text > MAX_EXPRESSION_TEXT:
            self._refuse(event, f"the texts with expressions have more than {MAX_EXPRESSION_TEXT} characters", hint)

    def _take_key(self, event: _Event, key: str, *, plain: bool) -> None:
        container = cast("dict[str, object]", self._container)
        if plain and key in ("", "~"):
            self._refuse_line(event, "a key is empty", "write a name before the `:`")
        if plain and key == "<<":
            self._refuse_line(event, "the merge key `<<` is not supported", "write the keys in full")
        if key in container:
            first = cast("dict[str | int, PositionTree]", self._place.children)[key]
            self._refuse_line(
                event, f"the key `{shorten_scalar(key)}` is repeated; it first occurs on line {first.key_line + 1}"
            )
        mark = event.start_mark
        self._key = (key, mark.line, mark.column)

    def _open(self, event: _Event, container: dict[str, object] | list[object]) -> None:
        mark = self._count(event)
        if type(self._container) is dict and self._key is None:
            self._refuse_line(event, "a key must be text, not a mapping or list", "put `${…}` and `{…}` in quotes")
        if len(self._stack) >= MAX_DEPTH:
            self._refuse(event, f"nested deeper than {MAX_DEPTH} levels", "split the document with behavior references")
        self.latest = container
        outer = (self._container, self._place, None)
        place = self._add(container, mark.line, mark.column)
        place.children = {}
        self._stack.append(outer)
        self._container, self._place, self._key = container, place, None

    def _add(self, value: object, line: int, column: int) -> PositionTree:
        container = self._container
        if container is None:
            self._root.append(value)
            self._root_place = PositionTree(line, column, line, column)
            return self._root_place
        children = cast("dict[str | int, PositionTree]", self._place.children)
        if type(container) is dict:
            key, key_line, key_column = cast("tuple[str, int, int]", self._key)
            self._key = None
            container[key] = value
            place = children[key] = PositionTree(key_line, key_column, line, column)
        else:
            place = PositionTree(line, column, line, column)
            if self._places:
                children[len(children)] = place
            cast("list[object]", container).append(value)
        return place

    def _resolve(self, event: _Event, text: str) -> object:
        try:
            return plain_scalar(text)
        except ValueError as error:
            self._refuse_line(event, str(error), "put it in quotes if it is text")

    def _refuse_line(self, event: _Event, message: str, hint: str | None = None) -> NoReturn:
        """Refuse a value; the rest of the text may be readable without it."""
        mark = event.start_mark
        where = Position(file=self._file, line=mark.line + 1, column=mark.column + 1)
        refusal = LineMistake(message, where=where, hint=hint)
        refusal.line = mark.line
        raise refusal

    def _refuse(self, event: _Event, message: str, hint: str | None = None) -> NoReturn:
        _refuse(self._file, event.start_mark.line, event.start_mark.column, message, hint)
