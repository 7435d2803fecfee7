"""Random changes of plain data: what an editor might do to it, and worse."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from hypothesis import strategies as st

from tests.engine.editing.layouts import KEYS, Plain, is_list, is_mapping, trees

Where = tuple[Any, ...]


def mutate(data: Plain, changes: st.DataObject) -> None:
    """Do one thing to data: set, add, drop, rename, reorder or move something."""
    place = changes.draw(st.sampled_from(list(collections(data))))
    found: Any = at(data, place)
    what = changes.draw(st.sampled_from(["set", "add", "drop", "rename", "reorder", "move"]))
    if is_list(found):
        if what in ("set", "rename") and found:
            found[changes.draw(st.integers(0, len(found) - 1))] = changes.draw(trees)
        elif what == "drop" and found:
            found.pop(changes.draw(st.integers(0, len(found) - 1)))
        elif what == "reorder":
            found[:] = changes.draw(st.permutations(found))
        elif what == "move" and found:
            moved = found.pop(changes.draw(st.integers(0, len(found) - 1)))
            _put(data, moved, changes)
        else:
            found.insert(changes.draw(st.integers(0, len(found))), changes.draw(trees))
        return
    key = changes.draw(st.sampled_from(list(found))) if found else None
    if key is None or what == "add":
        items = list(found.items())
        fresh = changes.draw(st.sampled_from([k for k in (*KEYS, "fresh", "new") if k not in found]))
        items.insert(changes.draw(st.integers(0, len(items))), (fresh, changes.draw(trees)))
        found.clear()
        found.update(items)
    elif what == "set":
        found[key] = changes.draw(trees)
    elif what == "drop":
        del found[key]
    elif what == "move":
        _put(data, found.pop(key), changes)
    else:
        items = list(changes.draw(st.permutations(list(found.items()))) if what == "reorder" else found.items())
        if what == "rename":
            fresh = changes.draw(st.sampled_from([k for k in (*KEYS, "fresh") if k not in found]))
            items = [(fresh if k == key else k, v) for k, v in items]
        found.clear()
        found.update(items)


def _put(data: Plain, moved: object, changes: st.DataObject) -> None:
    place = changes.draw(st.sampled_from(list(collections(data))))
    found: Any = at(data, place)
    if is_list(found):
        found.insert(changes.draw(st.integers(0, len(found))), moved)
    else:
        found[changes.draw(st.sampled_from([k for k in (*KEYS, "moved") if k not in found]))] = moved


def leaves(data: Any, path: Where = ()) -> Iterator[Where]:
    """Go through the paths of all values that are no collections."""
    if is_mapping(data):
        for key, each in data.items():
            yield from leaves(each, (*path, key))
    elif is_list(data):
        for index, each in enumerate(data):
            yield from leaves(each, (*path, index))
    else:
        yield path


def collections(data: Any, path: Where = ()) -> Iterator[Where]:
    """Go through the paths of all mappings and lists."""
    if is_mapping(data):
        yield path
        for key, each in data.items():
            yield from collections(each, (*path, key))
    elif is_list(data):
        yield path
        for index, each in enumerate(data):
            yield from collections(each, (*path, index))


def mappings(data: Plain) -> list[Where]:
    return [path for path in collections(data) if is_mapping(at(data, path))]


def at(data: Any, path: Where) -> Any:
    for step in path:
        data = data[step]
    return data


def set_at(data: Any, path: Where, value: object) -> None:
    at(data, path[:-1])[path[-1]] = value
