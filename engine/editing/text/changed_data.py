"""Finds the dicts and lists whose data is no longer what their text says."""

from __future__ import annotations

from collections.abc import Collection as Several
from operator import is_

from engine.editing.text.node_matching import is_same_value
from engine.editing.text.syntax import Collection


def changed_collections(sources: Several[Collection]) -> frozenset[Collection]:
    """Return those collections of a tree whose data, or that of one inside them, is not what their text says."""
    found: set[Collection] = set()
    for source in sources:
        data, content = source.data, source.read or source.content
        # Nearly all values are the same objects, which needs no call of a function for each.
        if isinstance(data, dict):
            if tuple(data) == content.keys and all(map(is_, content.values, data.values())):
                continue
            if tuple(data) != content.keys or not all(map(is_unchanged, content.values, data.values())):
                found.add(source)
        elif len(data) != len(content.values) or not all(map(is_unchanged, content.values, data)):
            found.add(source)
    if found:
        around = {inner: source for source in sources for inner in source.content.inside}
        due = list(found)
        while due:
            outer = around.get(due.pop())
            if outer is not None and outer not in found:
                found.add(outer)
                due.append(outer)
    return frozenset(found)


def is_unchanged(was: object, value: object) -> bool:
    """Return whether a value is the same object, or an equal scalar."""
    return was is value or (not isinstance(was, dict | list) and is_same_value(was, value))
