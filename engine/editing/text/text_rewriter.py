"""Writes changed plain data into the text it was read from: unchanged parts keep each of their bytes.

Data matches the text by identity. A dict or list that was read from a text keeps its text wherever it is moved and
under any key; renamed, moved or reordered parts therefore keep their text, including comments and
quotes. Only new values and changed scalars are rendered.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import cast

from engine.editing.text.block_style import (
    collections_in_flow,
    had_node,
    has_node,
    holds_items,
    holds_notes,
    lists_mappings,
)
from engine.editing.text.changed_data import changed_collections, is_unchanged
from engine.editing.text.indentation import indent_after, indent_text
from engine.editing.text.node_matching import EntryMatch, is_same_value, match_entries
from engine.editing.text.syntax import Collection, Member, Scalar, SourceText, Syntax, SyntaxTree
from engine.editing.text.yaml_style import flow_text, key_text, literal_text, scalar_text

MAX_COLUMNS = 120
"""Maximum line length up to which a new value is written on one line."""
_STEP = 2
Plain = dict[str, object] | list[object]


@dataclass(frozen=True)
class WritePosition:
    """Position of a value: column of its block, indentation of its line, and whether it is inside braces."""

    column: int
    indent: int
    flow: bool
    beside: bool | None = None
    """Whether its neighbours are in flow style; None without neighbours."""


@dataclass(frozen=True)
class PreviousValue:
    """The previous value in this position."""

    origin: SourceText
    value: Syntax


@dataclass(frozen=True)
class RenderedText:
    """The text of a value; a `block` has its own lines, the first of which begins at the column of its position."""

    text: str
    block: bool = False


@dataclass
class TextRewriter:
    """Renders data whose parts come from `sources`, by the id of each dict and list."""

    sources: Mapping[int, Collection]
    json: bool
    _homes: dict[int, tuple[Collection, Member]] = field(default_factory=dict[int, tuple[Collection, Member]])
    _blocks: dict[int, bool] = field(default_factory=dict[int, bool])

    @cached_property
    def changed(self) -> frozenset[Collection]:
        """The collections whose data, or that of one inside them, is not what their text says."""
        return changed_collections(self.sources.values())

    def document(self, tree: SyntaxTree, data: dict[str, object]) -> str:
        """Return the text of a tree with `data` instead of its own data."""
        origin, root = tree.origin, tree.root
        column = root.column if isinstance(root, Collection) else 0
        written = self.value(data, WritePosition(column, origin.indent_at(root.start), self.json))
        return origin.text[: root.start] + written.text + origin.text[root.end :]

    def value(self, value: object, place: WritePosition, was: PreviousValue | None = None) -> RenderedText:
        """Return the text of a value at a position."""
        if not isinstance(value, dict | list):
            return RenderedText(self._scalar(value, place, was))
        found = cast("Plain", value)
        source = self._source(found)
        if not found:
            kept = source is not None and source.flow and not source.entries and not source.bare
            return RenderedText(
                _slice(source) if source is not None and kept else "{}" if isinstance(found, dict) else "[]"
            )
        if source is not None and self._stays_flow(source, found, place):
            kept = self._is_whole(source, found)
            text = _slice(source) if kept else self._flow(source, match_entries(source, found, self.sources))
            stays = was is not None and was.value is source
            return RenderedText(
                text if stays else indent_text(text, place.indent - source.origin.indent_at(source.start))
            )
        if source is not None and not source.flow and not place.flow:
            kept = self._is_whole(source, found)
            text = _slice(source) if kept else self._block(source, match_entries(source, found, self.sources))
            return RenderedText(indent_text(text, place.column - source.column), block=True)
        return self._fresh(found, place)

    def _is_whole(self, source: Collection, value: Plain) -> bool:
        """Return whether a value and everything inside it is unchanged, so that its text can be reused."""
        return source.data is value and source not in self.changed and source.origin.json == self.json

    def _stays_flow(self, source: Collection, value: Plain, place: WritePosition) -> bool:
        """Return whether a value stays in flow style: unless a block value is inserted into it."""
        if not source.flow or not source.entries or source.bare or self._has_block(value):
            return False
        return place.flow or not has_node(value) or had_node(source)

    def _source(self, value: Plain) -> Collection | None:
        source = self.sources.get(id(value))
        return None if source is not None and self.json and not source.origin.json else source

    def _has_block(self, value: object) -> bool:
        """Return whether a part of it is a block value, which cannot be written in flow style."""
        if not isinstance(value, dict | list):
            return False
        found = cast("Plain", value)
        known = self._blocks.get(id(found))
        if known is None:
            source = self._source(found)
            own = source is not None and not source.flow and bool(found)
            known = self._blocks[id(found)] = own or any(self._has_block(each) for each in _inside(found))
        return known

    def _scalar(self, value: object, place: WritePosition, was: PreviousValue | None) -> str:
        if was is None or not isinstance(was.value, Scalar):
            return scalar_text(value, json=self.json, flow=place.flow)
        old = was.value
        if is_same_value(old.value, value) and old.end > old.start and was.origin.json == self.json:
            return was.origin.text[old.start : old.end]
        style = old.style if isinstance(old.value, str) and isinstance(value, str) else ""
        return scalar_text(value, json=self.json, flow=place.flow, style=style)

    # Flow style

    def _flow(self, source: Collection, entries: list[EntryMatch]) -> str:
        text, members = source.origin.text, source.members
        gaps = [text[one.stop : two.at] for one, two in itertools.pairwise(members)]
        gap = self._usual_gap(source, gaps)
        indent = indent_after(gap, source.origin.indent_at(source.start))
        made = text[source.start : members[0].at]
        places = {id(member): place for place, member in enumerate(members)}
        before = -2
        for number, (key, value, member) in enumerate(entries):
            place = places[id(member)] if member is not None else -2
            if number:
                made += gaps[before] if place == before + 1 else gap
            made += self._flow_entry(source.origin, key, value, member, indent)
            before = place
        return made + text[members[-1].stop : source.end]

    def _usual_gap(self, source: Collection, gaps: list[str]) -> str:
        plain = next((gap for gap in reversed(gaps) if "#" not in gap), None)
        if plain is not None:
            return plain
        lead = source.origin.text[source.start + 1 : source.members[0].at]
        return f",{lead}" if lead.startswith("\n") and "#" not in lead else ", "

    def _flow_entry(
        self, origin: SourceText, key: str | None, value: object, member: Member | None, indent: int
    ) -> str:
        was = PreviousValue(origin, member.value) if member is not None else None
        shown = self.value(value, WritePosition(indent + _STEP, indent, flow=True), was).text
        if key is None:
            return shown
        if member is None or member.key is None:
            return f"{key_text(key, json=self.json)}: {shown}"
        text = origin.text
        gap = text[member.key.end : member.value.start]
        if not gap.rstrip().endswith(":"):
            if isinstance(member.value, Scalar) and value is None and member.value.value is None:
                return text[member.at : member.stop] if key == member.key.value else key_text(key, json=self.json)
            gap = ": "
        elif member.value.start == member.value.end:
            if value is None:
                shown = ""
            else:
                gap = f"{gap} "
        name = text[member.at : member.key.end] if key == member.key.value else key_text(key, json=self.json)
        return name + gap + shown

    # Block style

    def _block(self, source: Collection, entries: list[EntryMatch]) -> str:
        place = WritePosition(source.column, source.column, flow=False, beside=collections_in_flow(source))
        segments: list[str] = []
        first = source.members[0]
        begin, stop = 0, -1
        # Entries that stay and follow one another in the text are one slice of it.
        for key, value, member in entries:
            stays = member is not None and member is not first and self._stays(source, key, value, member)
            if stays and member is not None and member.start == stop + 1:
                stop = member.stop
                continue
            if stop >= 0:
                segments.append(source.origin.text[begin:stop])
                stop = -1
            if stays and member is not None:
                begin, stop = member.start, member.stop
            else:
                segments.append(self._segment(place, key, value, None if member is None else (source, member)))
        if stop >= 0:
            segments.append(source.origin.text[begin:stop])
        return "\n".join([segments[0].lstrip(" \n"), *segments[1:]])

    def _segment(
        self, place: WritePosition, key: str | None, value: object, was: tuple[Collection, Member] | None
    ) -> str:
        """Return the lines of one entry of a block at a position, with the comments above it."""
        elsewhere = was is None
        was = was or self._moved(value)
        if was is None:
            return " " * place.column + self._entry(key, value, place)
        home, member = was
        if not elsewhere and self._stays(home, key, value, member):
            begin = " " * home.column if member is home.members[0] else ""
            return begin + home.origin.text[member.start : member.stop]
        lead = home.origin.text[member.start : member.at]
        if member is home.members[0]:
            lead = " " * home.column + lead
        elif elsewhere:
            lead = lead.lstrip("\n")
        segment = lead + self._block_entry(home, key, value, member)
        return indent_text(segment, place.column - home.column, first=True)

    def _stays(self, home: Collection, key: str | None, value: object, member: Member) -> bool:
        """Return whether an entry is as it was, so that its lines can be reused."""
        was = member.value
        if home.origin.json != self.json or key != (member.key.value if member.key is not None else None):
            return False
        if isinstance(was, Collection):
            return was.data is value and bool(value) and self._is_whole(was, was.data)
        return is_unchanged(was.value, value)

    def _moved(self, value: object) -> tuple[Collection, Member] | None:
        """Return the original entry of a moved value, whose comments move with it."""
        if not isinstance(value, dict | list):
            return None
        origin = self._source(cast("Plain", value))
        home = self._home_of(origin) if origin is not None else None
        return home if home is not None and not home[0].flow else None

    def _brings_comments(self, value: Plain) -> bool:
        """Return whether entries with comments were moved into a new value."""
        for each in _inside(value):
            moved = self._moved(each)
            if moved is not None:
                text, member = moved[0].origin.text, moved[1]
                if "#" in text[member.start : member.at] + text[member.value.end : member.stop]:
                    return True
            elif isinstance(each, dict | list) and self._brings_comments(cast("Plain", each)):
                return True
        return False

    def _home_of(self, origin: Collection) -> tuple[Collection, Member] | None:
        """Return the original entry of a collection of a text."""
        if not self._homes:
            for collection in self.sources.values():
                for member in collection.entries:
                    self._homes[id(member.value)] = (collection, member)
        return self._homes.get(id(origin))

    def _block_entry(self, home: Collection, key: str | None, value: object, member: Member) -> str:
        text, old = home.origin.text, member.value
        name, gap = self._name(home, key, member)
        tail = text[old.end : member.stop]
        if isinstance(old, Scalar) and not isinstance(value, dict | list):
            return name + self._scalar_entry(home, value, old, gap, tail)
        was_block = isinstance(old, Collection) and not old.flow
        stays = isinstance(old, Collection) and was_block and isinstance(value, type(old.data))
        # From a list into a mapping, or the other way round: the value begins beside another mark.
        crosses = (key is None) != (member.key is None)
        stays = stays and not crosses
        column = old.column if isinstance(old, Collection) and stays else home.column + _STEP
        beside = old.flow if isinstance(old, Collection) and had_node(old) else None
        place = WritePosition(column, indent_after(gap, home.column), flow=False, beside=beside)
        written = self.value(cast("object", value), place, PreviousValue(home.origin, old))
        mark = "" if key is None else ":"
        if written.block and not stays:
            # A comment after the old value stays after the key.
            first, _, rest = tail.partition("\n")
            if crosses:
                first = first or _comment_beside(home, member)
            behind = f"{first}\n{' ' * column}" if key is not None or first else " "
            return f"{name}{mark}{behind}{written.text}" + (f"\n{rest}" if rest else "")
        if was_block and not written.block:
            comment = gap.partition(":")[2] if key is not None else gap
            return f"{name}{mark} {written.text}{comment.rstrip()}{tail}"
        if not written.block and not gap.endswith((" ", "\n")):
            gap += " "
        return name + gap + written.text + tail

    def _scalar_entry(self, home: Collection, value: object, old: Scalar, gap: str, tail: str) -> str:
        """Return gap, value and tail of an entry that is and was a scalar."""
        if is_same_value(old.value, value):
            return gap + home.origin.text[old.start : old.end] + tail
        shown = None
        if isinstance(value, str) and "#" not in tail:
            shown = literal_text(value, home.column + _STEP)
        if shown is None:
            place = WritePosition(home.column + _STEP, home.column, flow=False)
            shown = self._scalar(value, place, PreviousValue(home.origin, old))
        return gap + ("" if gap.endswith((" ", "\n")) else " ") + shown + tail

    def _name(self, home: Collection, key: str | None, member: Member) -> tuple[str, str]:
        """Return the key as written, or the dash, and the text between it and the value."""
        text = home.origin.text
        if key is None:
            return "-", text[member.at + 1 : member.value.start] if member.key is None else " "
        if member.key is None:
            return key_text(key, json=self.json), ": "
        name = text[member.at : member.key.end]
        if key != member.key.value:
            name = text[member.at : member.key.start] + key_text(key, json=self.json)
        return name, text[member.key.end : member.value.start]

    def _entry(self, key: str | None, value: object, place: WritePosition) -> str:
        """Return a new entry of a block."""
        inside = WritePosition(place.column + _STEP, place.column, flow=False, beside=place.beside)
        written = self.value(value, inside)
        shown = written.text
        if isinstance(value, str):
            shown = literal_text(value, inside.column) or shown
        if key is None:
            return f"- {shown}"
        between = f"\n{' ' * inside.column}" if written.block else " "
        return f"{key_text(key, json=self.json)}:{between}{shown}"

    # New values

    def _fresh(self, value: Plain, place: WritePosition) -> RenderedText:
        if self.json:
            return RenderedText(self._fresh_json(value, place))
        blocks = self._has_block(value)
        if place.flow or not blocks:
            text = self._fresh_flow(value, place)
            fits = place.column + len(text) <= MAX_COLUMNS and "\n" not in text
            lines = has_node(value) or lists_mappings(value) or holds_notes(value)
            joins = (place.beside is True or not lines) and not holds_items(value)
            if place.flow or (fits and joins and not self._brings_comments(value)):
                return RenderedText(text)
        source = self.sources.get(id(value))
        beside = collections_in_flow(source) if source is not None and had_node(source) else None
        here = WritePosition(place.column, place.column, flow=False, beside=beside)
        entries = value.items() if isinstance(value, dict) else ((None, each) for each in value)
        segments = [self._segment(here, key, each, None) for key, each in entries]
        return RenderedText("\n".join([segments[0].lstrip(" \n"), *segments[1:]]), block=True)

    def _fresh_flow(self, value: Plain, place: WritePosition) -> str:
        inside = WritePosition(place.column, place.indent, flow=True)
        if isinstance(value, dict):
            shown = [f"{key_text(k, json=self.json)}: {self.value(v, inside).text}" for k, v in value.items()]
            return "{" + ", ".join(shown) + "}"
        return "[" + ", ".join(self.value(each, inside).text for each in value) + "]"

    def _fresh_json(self, value: Plain, place: WritePosition) -> str:
        line = flow_text(value, json=True)
        if place.indent + len(line) <= MAX_COLUMNS and not has_node(value):
            return line
        indent = place.indent + _STEP
        inside = WritePosition(indent, indent, flow=True)
        if isinstance(value, dict):
            shown = [f"{key_text(k, json=True)}: {self.value(v, inside).text}" for k, v in value.items()]
        else:
            shown = [self.value(each, inside).text for each in value]
        around = "{}" if isinstance(value, dict) else "[]"
        between = f",\n{' ' * indent}"
        return f"{around[0]}\n{' ' * indent}{between.join(shown)}\n{' ' * place.indent}{around[1]}"


def _inside(value: Plain) -> Iterable[object]:
    return value.values() if isinstance(value, dict) else value


def _comment_beside(home: Collection, member: Member) -> str:
    """Return the comment behind the key or dash of an entry whose value begins on the next line."""
    mark_end = member.key.end if member.key is not None else member.at
    line = home.origin.text[mark_end : member.value.start].partition("\n")[0][1:]
    return line if "#" in line else ""


def _slice(source: Collection) -> str:
    return source.origin.text[source.start : source.end]
