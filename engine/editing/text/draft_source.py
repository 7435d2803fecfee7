"""A text under edit as the source of a behavior: its data, and positions that are looked up when they are needed."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate
from typing import cast

from engine.document.behavior import Behavior
from engine.document.text.yaml_source import DataPath, DocumentSource, PositionTree, parse_source
from engine.editing.text.draft import Draft
from engine.editing.text.outline import Outline
from engine.editing.text.syntax import Collection, Member, Syntax
from engine.errors import Position


def syntax_source(draft: Draft) -> DocumentSource:
    """Return the source of a draft that has not been changed since it was read; it is valid until it changes.

    Nodes that were decoded before are the same objects as then.
    """
    data = {key: _decoded(value, draft) if key == "root" else value for key, value in draft.data.items()}
    return _SyntaxSource(file=draft.file, data=data, place=PositionTree(0, 0, 0, 0), draft=draft)


def keep_nodes(behavior: Behavior, draft: Draft, outline: Outline) -> None:
    """Keep the nodes that were decoded from a draft, for the source of the next one."""
    for path, node in behavior.nodes():
        source = draft.source_of(outline.refs[path].data)
        if source is not None:
            source.node = node


def _decoded(value: object, draft: Draft) -> object:
    if not isinstance(value, dict | list):
        return value
    source = draft.source_of(cast("object", value))
    if source is not None and source.node is not None:
        return source.node
    if isinstance(value, dict):
        return {key: _decoded(each, draft) for key, each in cast("dict[str, object]", value).items()}
    return [_decoded(each, draft) for each in cast("list[object]", value)]


# No slots: cached properties need a `__dict__`.
@dataclass(frozen=True, kw_only=True)
class _SyntaxSource(DocumentSource):
    draft: Draft = field(repr=False)

    @cached_property
    def _starts(self) -> list[int]:
        lines = self.draft.origin.text.split("\n")
        return list(accumulate((len(line) + 1 for line in lines), initial=0))[:-1]

    @cached_property
    def _parsed(self) -> DocumentSource:
        return parse_source(self.draft.given, file=self.file)

    def position(self, path: DataPath, *, of_key: bool = False) -> Position:
        """Return the position of the value (or the key) at `path`, or of its nearest existing ancestor."""
        found: Syntax | None = self.draft.source_of(self.draft.data)
        member: Member | None = None
        for step in path:
            inside = _inside(found, step)
            if inside is None:
                of_key = True
                break
            member, found = inside, inside.value
        if self.draft.json or found is None or _is_omitted(found):
            return self._parsed.position(path, of_key=of_key)
        if of_key and member is not None and member.key is not None:
            return self._at(member.key.start)
        if of_key and member is None:
            return self._parsed.position((), of_key=True)
        return self._at(_start(found))

    def _at(self, offset: int) -> Position:
        line = bisect_right(self._starts, offset) - 1
        return Position(file=self.file, line=line + 1, column=offset - self._starts[line] + 1)


def _inside(found: Syntax | None, step: str | int) -> Member | None:
    if not isinstance(found, Collection):
        return None
    if isinstance(found.data, list):
        return found.members[step] if isinstance(step, int) and 0 <= step < len(found.members) else None
    return next((member for member in found.members if member.key is not None and member.key.value == step), None)


def _is_omitted(found: Syntax) -> bool:
    return not isinstance(found, Collection) and found.start == found.end


def _start(found: Syntax) -> int:
    """Return where a value begins, without the comments above a block."""
    return found.members[0].at if isinstance(found, Collection) and not found.flow else found.start
