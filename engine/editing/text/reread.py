"""Reads a changed text with the tree of the text before: only lines that differ are parsed again.

The parser reads from left to right, and the lines of an entry of a block mapping end where a line begins with as
many spaces as its own. Such lines therefore mean the same wherever they are the lines of a whole entry, and can be
parsed alone. Whatever does not fit this rule is left to a full read.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import cast

from engine.document.text.yaml_source import (
    MAX_BYTES,
    MAX_DEPTH,
    MAX_EXPRESSION_TEXT,
    MAX_EXPRESSIONS,
    MAX_NODES,
)
from engine.editing.text.node_matching import is_equal_data, is_same_value
from engine.editing.text.same_ends import same_ends
from engine.editing.text.syntax import (
    Collection,
    Member,
    Scalar,
    SourceText,
    Syntax,
    SyntaxTree,
    block_start,
    last_line,
    read_entries,
)
from engine.errors import DocumentError

_LOOK_AHEAD = 4
"""Number of entries of which the next one that both texts contain is searched."""
_MARKERS = ("---", "...", "%")
"""What a line that is no entry begins with: a document, or a directive, begins or ends there."""
Plain = dict[str, object]


class _Unlike(Exception):
    """The texts differ in a way that only a full read understands."""


@dataclass(frozen=True)
class RereadTree:
    """A tree with its data, and the collections by the id of each dict and list."""

    tree: SyntaxTree
    data: Plain
    sources: dict[int, Collection]


def reread(
    before: SyntaxTree,
    text: str,
    data: Plain | None,
    *,
    file: str,
    sources: dict[int, Collection],
    changed: frozenset[Collection],
) -> RereadTree | None:
    """Return the tree of `text` if it says `data`; it consumes the tree `before`. None asks for a full read.

    A collection whose lines are the same is the same object as before; every other one is new.

    Args:
        before: The tree of the text before.
        text: The new text, with lines that end in a line feed.
        data: The data of `before` after an edit: unchanged dicts and lists are the same objects. None for any text.
        file: Its name, for positions.
        sources: The collections of `before` by the id of their data; it becomes that of the new tree.
        changed: Collections of `before` whose data, or that of one inside them, is not what the text said.
    """
    root = before.root
    if before.origin.json or not isinstance(root, Collection) or root.flow or len(text) > MAX_BYTES:
        return None
    old = before.origin.text
    # The one text of all collections, also of those that are not looked at again.
    before.origin.text = text
    reading = _Rereading(old, before.origin, file, sources, changed)
    try:
        made = reading.document(root)
        reading.take(made, reading.data_of(made) if data is None else data, 0, 1)
        reading.require_limits()
        reading.forget_gone()
    except (_Unlike, DocumentError):
        return None
    return RereadTree(SyntaxTree(reading.origin, made), cast("Plain", made.data), reading.sources)


@dataclass
class _Rereading:
    old: str
    origin: SourceText
    file: str
    sources: dict[int, Collection]
    changed: frozenset[Collection]
    _shifts: dict[Collection, list[int | None]] = field(default_factory=dict[Collection, "list[int | None]"])
    """By new collection around kept members: how far each of them moved; None for a new one."""
    _homes: dict[Collection, Collection] = field(default_factory=dict[Collection, Collection])
    """By such a collection: the one that it replaces."""
    _gone: list[Collection] = field(default_factory=list[Collection])
    """Collections of the old tree without a part in the new one."""
    _nodes: int = 0
    _expressions: int = 0
    _expression_text: int = 0

    def __post_init__(self) -> None:
        self._ends = same_ends(self.old, self.origin.text)

    def document(self, root: Collection) -> Collection:
        """Return the new root, whose kept members have their old positions until `take`."""
        start = self._line(root.members[0]) if root.members else 0
        if not root.members or self.old[:start] != self.origin.text[:start]:
            raise _Unlike
        return self._around(root, len(self.old), start, len(self.origin.text))

    def _around(self, home: Collection, old_end: int, start: int, end: int) -> Collection:
        """Return a block mapping whose lines are `start` to `end` of the new text and went to `old_end`."""
        if home.flow or not isinstance(home.data, dict) or not home.members:
            raise _Unlike
        members, shifts = self._entries(home, old_end, start, end)
        if not members:
            raise _Unlike
        first = members[0].at + (shifts[0] or 0)
        begin = block_start(self.origin.text, first, home.column)
        made = Collection(self.origin, begin, begin, False, home.column, {}, members)
        self._shifts[made] = shifts
        self._homes[made] = home
        return made

    def _entries(self, home: Collection, old_end: int, start: int, end: int) -> tuple[list[Member], list[int | None]]:
        text = self.origin.text
        head, rest = self._ends.members(home.members, at_head=self._line(home.members[0]) == start, moved=end - old_end)
        olds = home.members[head:rest]
        begins = [*map(self._line, home.members[head : rest + 1]), *([old_end] if rest == len(home.members) else [])]
        to_end = end - (old_end - begins[-1])
        tail = self._equal_tail(begins, start, to_end)
        stop, last = to_end - (begins[-1] - begins[tail]), tail
        made = home.members[:head]
        shifts: list[int | None] = [0] * head
        at, number = begins[0] if head else start, 0
        while number < last:
            size = begins[number + 1] - begins[number]
            if self._is_equal(begins[number], begins[number + 1], at, stop):
                made.append(olds[number])
                shifts.append(at - begins[number])
                at, number = at + size, number + 1
                continue
            following, to = self._next_common(olds, begins, number, last, at, stop)
            if following == number and to == at:
                follower, to = self._next_common(olds, begins, number + 1, last, at + 1, stop)
                changed = self._changed(olds[number], begins[number], begins[number + 1], at, to)
                fresh = [changed] if changed is not None else read_entries(self.origin, at, to, home.column, self.file)
                self._let_go(olds[number + 1 if changed is not None else number : follower])
                number = follower
            else:
                fresh = read_entries(self.origin, at, to, home.column, self.file) if to > at else []
                self._let_go(olds[number:following])
                number = following
            self._require_entries(fresh, home, at, to)
            made += fresh
            shifts += [None] * len(fresh)
            at = to
        if at < stop:
            fresh = read_entries(self.origin, at, stop, home.column, self.file)
            self._require_entries(fresh, home, at, stop)
            made += fresh
            shifts += [None] * len(fresh)
        made += [*olds[tail:], *home.members[rest:]]
        shifts += [end - old_end] * (len(made) - len(shifts))
        if text[end - 1 : end] not in ("\n", "") and end < len(text):
            raise _Unlike
        return made, shifts

    def _equal_tail(self, begins: list[int], start: int, end: int) -> int:
        """Return the number of the first of the last members whose lines are the same in both texts."""
        number, shift = len(begins) - 1, end - begins[-1]
        while number > 0:
            begin = begins[number - 1]
            if begin + shift < start or not self.origin.text.startswith(
                self.old[begin : begins[number]], begin + shift
            ):
                break
            # The line before the first of them must end there.
            number -= 1
        while number < len(begins) - 1 and not self._begins_line(begins[number] + shift):
            number += 1
        return number

    def _begins_line(self, at: int) -> bool:
        return at == 0 or self.origin.text[at - 1] == "\n"

    def _is_equal(self, begin: int, end: int, at: int, stop: int) -> bool:
        to = at + end - begin
        if to > stop or not self.origin.text.startswith(self.old[begin:end], at):
            return False
        return self.old[end - 1] == "\n" or to == len(self.origin.text)

    def _next_common(
        self, olds: list[Member], begins: list[int], number: int, last: int, at: int, stop: int
    ) -> tuple[int, int]:
        """Return the next member whose key line is in both texts, and where it is; `last` and `stop` if none."""
        found, place = last, stop
        for each in range(number, min(last, number + _LOOK_AHEAD)):
            line = self._key_line(olds[each], begins[each])
            if self._begins_line(at) and self.origin.text.startswith(line, at, place):
                return each, at
            before = self.origin.text.find(f"\n{line}", at, place)
            if before >= 0:
                found, place = each, before + 1
        return found, place

    def _changed(self, was: Member, begin: int, old_end: int, at: int, to: int) -> Member | None:
        """Return an entry with the same key and a block mapping as its value; None if it is read anew."""
        value, key = was.value, was.key
        if key is None or not isinstance(value, Collection) or value.flow or not isinstance(value.data, dict):
            return None
        try:
            inner = self._line(value.members[0])
            start = at + inner - begin
            if inner <= key.end or self.origin.text[at:start] != self.old[begin:inner]:
                return None
            made = self._around(value, old_end, start, to)
        except (_Unlike, DocumentError):
            return None
        by = at - begin
        moved = Scalar(key.start + by, key.end + by, key.value, key.style)
        return Member(was.at + by, was.at + by, moved, made, 0)

    def _require_entries(self, fresh: list[Member], home: Collection, at: int, to: int) -> None:
        if to > at and (not fresh or fresh[0].at != at + home.column):
            raise _Unlike
        # Most of the text may be between the two: a regular expression takes milliseconds.
        text = self.origin.text
        if any(text.startswith(each, at, to) or text.find(f"\n{each}", at, to) >= 0 for each in _MARKERS):
            raise _Unlike

    def _line(self, member: Member) -> int:
        """Return the start of the line of a key, before which there are only spaces."""
        begin = self.old.rfind("\n", 0, member.at) + 1
        if self.old[begin : member.at].strip(" ") or member.key is None or member.key.start != member.at:
            raise _Unlike
        return begin

    def _key_line(self, member: Member, begin: int) -> str:
        key = cast("Scalar", member.key)
        if self.old[key.end : key.end + 1] != ":":
            raise _Unlike
        return self.old[begin : key.end + 1]

    # The second pass: positions, and the proof that the text says the data

    def take(self, found: Collection, value: object, by: int, depth: int) -> None:
        """Move a collection and everything inside it, and require that it says `value`."""
        found.move(by)
        if value is found.data and self._is_unchanged(found):
            content = found.content
            self._nodes += content.nodes
            self._expressions += content.expressions
            self._expression_text += content.expression_text
            return
        shifts = self._shifts.get(found)
        if depth > MAX_DEPTH or (shifts is None and value is not found.data) or type(value) is not type(found.data):
            raise _Unlike
        data = found.data = value
        was = self.sources.get(id(data), found)
        if (was is not found and was is not self._homes.get(found)) or len(data) != len(found.entries):
            raise _Unlike
        self.sources[id(data)] = found
        self._nodes += 1
        if shifts is not None:
            self._take_entries(found, cast("Plain", data), shifts, depth)
        elif isinstance(data, dict):
            self._nodes += len(data)
            for member, (key, inner) in zip(found.members, data.items(), strict=True):
                own = cast("Scalar", member.key)
                if own.value != key:
                    raise _Unlike
                self._value(member.value, inner, depth)
        else:
            for member, inner in zip(found.members, data, strict=True):
                self._value(member.value, inner, depth)

    def _is_unchanged(self, found: Collection) -> bool:
        return found not in self.changed and self.sources.get(id(found.data)) is found

    def data_of(self, found: Collection) -> Plain | list[object]:
        """Return the data of a collection; that of kept and new parts is the one that was read."""
        if found not in self._shifts:
            return found.data
        parts = ((cast("Scalar", member.key).value, member.value) for member in found.entries)
        return {str(key): self.data_of(part) if isinstance(part, Collection) else part.value for key, part in parts}

    def _take_entries(self, found: Collection, data: Plain, shifts: list[int | None], depth: int) -> None:
        previous = found.start
        # Nearly all entries are kept: those are looked at here, without calls of functions.
        changed, sources = self.changed, self.sources
        nodes = expressions = expression_text = 0
        for number, (member, shift, key) in enumerate(zip(found.members, shifts, list(data), strict=True)):
            own = cast("Scalar", member.key)
            if own.value != key:
                raise _Unlike
            self._nodes += 1
            if shift is not None:
                if shift:
                    member.move(shift)
                value, inner = member.value, data[key]
                if (
                    isinstance(value, Collection)
                    and value.data is inner
                    and value not in changed
                    and sources.get(id(inner)) is value
                ):
                    if shift:
                        value.move(shift)
                    content = value.read or value.content
                    nodes += content.nodes
                    expressions += content.expressions
                    expression_text += content.expression_text
                else:
                    self._value(value, inner, depth, by=shift)
            elif isinstance(member.value, Collection):
                if member.value not in self._shifts:
                    self._adopt(member.value, data, key)
                self.take(member.value, data[key], 0, depth + 1)
            else:
                self._value(member.value, data[key], depth)
            member.start = min(previous + 1, member.at) if number else previous
            if shift is None:
                end = max(member.value.end, member.at + 1)
                member.stop = last_line(self.origin.text, end, found.column)
            previous = member.stop
        found.end = previous
        self._nodes += nodes
        self._expressions += expressions
        self._expression_text += expression_text

    def _adopt(self, fresh: Collection, data: Plain, key: str) -> None:
        """Put the data that was read in the place of equal data of an edit, which others may hold."""
        if not is_equal_data(fresh.data, data[key]):
            raise _Unlike
        data[key] = fresh.data

    def _value(self, found: Syntax, value: object, depth: int, *, by: int = 0) -> None:
        if isinstance(found, Collection):
            self.take(found, value, by, depth + 1)
            return
        self._nodes += 1
        was = found.value
        if was is not value and not is_same_value(was, value):
            raise _Unlike
        found.move(by)
        if isinstance(was, str) and "${" in was:
            self._expressions += was.count("${")
            self._expression_text += len(was)

    def _let_go(self, olds: Sequence[Member]) -> None:
        self._gone += [member.value for member in olds if isinstance(member.value, Collection)]

    def forget_gone(self) -> None:
        """Remove what the text no longer contains from the sources."""
        # Of one that was replaced, the members are kept or gone by themselves.
        for home in self._homes.values():
            self._forget(home)
        while self._gone:
            gone = self._gone.pop()
            self._forget(gone)
            self._gone += gone.content.inside

    def _forget(self, gone: Collection) -> None:
        if self.sources.get(id(gone.data)) is gone:
            del self.sources[id(gone.data)]

    def require_limits(self) -> None:
        """Leave a text beyond the limits of a document to a full read, which says so."""
        if (
            self._nodes > MAX_NODES
            or self._expressions > MAX_EXPRESSIONS
            or self._expression_text > MAX_EXPRESSION_TEXT
        ):
            raise _Unlike
