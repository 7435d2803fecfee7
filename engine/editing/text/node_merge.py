"""Three-way merge of documents by nodes and fields: what only one side changed is taken, the rest is for a person."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Literal, cast

import msgspec

from engine.document.text.yaml_source import parse_source
from engine.editing.text.draft import Draft, EditRefused
from engine.editing.text.node_matching import is_equal_data
from engine.editing.text.outline import Outline, Plain, child_entries, kind_of, tree_names
from engine.editing.text.three_way_merge import merge_texts
from engine.errors import DocumentError

Side = Literal["mine", "theirs"]
DOCUMENT_PATH = "document"
_CANVAS_NOTES = "canvas_notes."
_NAME_LISTS = frozenset(("outcomes", "success", "choices", "shared", "next"))
"""Lists of names, of which each side may add and remove some."""


class NodeConflict(msgspec.Struct, frozen=True, kw_only=True):
    """A field that both sides changed differently.

    Attributes:
        path: The node, `document` for the document itself.
        field: The field, `with.speed`; empty for the node as a whole: one side removed or replaced it.
        base: What both started with; None where it did not exist, as for the two sides.
        mine: The value of who saves.
        theirs: The value in the file.
        side: Which of them is in the merged text.
    """

    path: str
    field: str
    base: object
    mine: object
    theirs: object
    side: Side

    @property
    def key(self) -> str:
        """What a choice is made for."""
        return f"{self.path} {self.field}"


class NodeMerge(msgspec.Struct, frozen=True, kw_only=True):
    """A text with the changes of both sides; `theirs_changed` are the nodes that the file changed."""

    text: str
    conflicts: tuple[NodeConflict, ...]
    theirs_changed: tuple[str, ...]


def merge_by_nodes(base: str, mine: str, theirs: str, *, file: str, sides: Mapping[str, Side]) -> NodeMerge | None:
    """Merge two texts that were made of the same one; None if they cannot be read, or not be written as one.

    Args:
        base: What both started with.
        mine: The text of who saves.
        theirs: The text of the file, whose layout is kept.
        file: Name of the document.
        sides: The choices by `NodeConflict.key`; without one a conflict has the value of who saves.
    """
    try:
        started, draft = Draft(base, file=file), Draft(theirs, file=file)
        merging = _Merging(started.data, draft.adopt(mine), draft.data, sides)
        merging.document()
        text = _by_lines(base, mine, theirs, draft.data, file) or draft.text()
    except (DocumentError, EditRefused):
        return None
    return NodeMerge(text=text, conflicts=tuple(merging.conflicts), theirs_changed=tuple(merging.theirs_changed))


def _by_lines(base: str, mine: str, theirs: str, data: Plain, file: str) -> str | None:
    """Return the merge of the lines, which has the comments of both sides, if it says the same."""
    made = merge_texts(base, mine, theirs).text
    try:
        return made if made is not None and is_equal_data(parse_source(made, file=file).data, data) else None
    except DocumentError:
        return None


class _Absent:
    """No value."""


_ABSENT = _Absent()


class _Merging:
    """Changes the data of the file so that it has both changes; the data of the other two is read only."""

    def __init__(self, base: Plain, mine: Plain, theirs: Plain, sides: Mapping[str, Side]) -> None:
        self._base = base
        self._mine = mine
        self._theirs = theirs
        self._sides = sides
        self._nodes = {id(ref.data): path for path, ref in Outline(theirs).refs.items()}
        self.conflicts: list[NodeConflict] = []
        self.theirs_changed: list[str] = list(_changed_nodes(Outline(base), Outline(theirs)))

    def document(self) -> None:
        self._mappings(self._base, self._mine, self._theirs, DOCUMENT_PATH, "")

    def _mappings(self, base: Plain, mine: Plain, theirs: Plain, path: str, field: str) -> None:
        for key in dict.fromkeys((*theirs, *mine, *base)):
            here = f"{field}.{key}" if field else key
            self._entry(
                base.get(key, _ABSENT),
                mine.get(key, _ABSENT),
                theirs.get(key, _ABSENT),
                path,
                here,
                lambda value, key=key: _put(theirs, key, value, mine),
            )

    def _entry(
        self, base: object, mine: object, theirs: object, path: str, field: str, put: Callable[[object], None]
    ) -> None:
        """Merge one value; `put` writes it into the data of the file."""
        if _same(mine, base) or _same(mine, theirs):
            return
        if _same(theirs, base) or _is_place(field):
            put(mine)
            return
        node = self._node_of(base, mine, theirs, path, field)
        if node is not None:
            path, field = node, ""
            if _is_replaced(base, mine) or _is_replaced(base, theirs):
                self._decide(base, mine, theirs, path, field, put)
                return
        if isinstance(mine, dict) and isinstance(theirs, dict) and isinstance(base, dict | _Absent):
            started = cast("Plain", base) if isinstance(base, dict) else {}
            one, two = cast("Plain", mine), cast("Plain", theirs)
            if field.endswith(".states"):
                started, one = _with_renamed(started, one, two), _with_renamed_back(started, one, two)
            self._mappings(started, one, two, path, field)
        elif isinstance(mine, list) and isinstance(theirs, list) and isinstance(base, list):
            self._lists(
                cast("list[object]", base), cast("list[object]", mine), cast("list[object]", theirs), path, field, put
            )
        else:
            self._decide(base, cast("object", mine), cast("object", theirs), path, field, put)

    def _lists(
        self,
        base: list[object],
        mine: list[object],
        theirs: list[object],
        path: str,
        field: str,
        put: Callable[[object], None],
    ) -> None:
        if field.rpartition(".")[2] in _NAME_LISTS:
            kept = [each for each in theirs if each in mine or each not in base]
            put([*kept, *(each for each in mine if each not in base and each not in theirs)])
            return
        names = [_names(each) for each in (base, mine, theirs)]
        if names[0] is None or names[0] != names[1] or names[1] != names[2]:
            self._decide(base, mine, theirs, path, field, put)
            return
        for index, (was, one, two) in enumerate(zip(base, mine, theirs, strict=True)):
            self._entry(was, one, two, path, f"{field}.{index}", lambda value, at=index: _put_item(theirs, at, value))

    def _node_of(self, base: object, mine: object, theirs: object, path: str, field: str) -> str | None:
        """Return the path of the node that the values are; None if they are none."""
        known = self._nodes.get(id(theirs))
        if known is not None:
            return known
        if field.endswith(".states") or ".states." not in f".{field}":
            return None
        head, _, name = field.rpartition(".")
        is_node = head.endswith(".states") and any(isinstance(each, dict) for each in (base, mine, theirs))
        return f"{path}/{name}" if is_node else None

    def _decide(
        self, base: object, mine: object, theirs: object, path: str, field: str, put: Callable[[object], None]
    ) -> None:
        if path == DOCUMENT_PATH and field.startswith("notes."):
            path, field = field.removeprefix("notes."), "note"
        elif path == DOCUMENT_PATH and field.startswith(_CANVAS_NOTES):
            path, _, field = field.removeprefix(_CANVAS_NOTES).partition(".")
            field = f"canvas note {field}".rstrip()
        side = self._sides.get(f"{path} {field}", "mine")
        values = (None if isinstance(each, _Absent) else each for each in (base, mine, theirs))
        started, one, two = values
        self.conflicts.append(NodeConflict(path=path, field=field, base=started, mine=one, theirs=two, side=side))
        if side == "mine":
            put(mine)


def _is_place(field: str) -> bool:
    """Return whether a field is a place or size on the canvas: of those the one of who saves is taken."""
    return field.startswith("view.") or (field.startswith(_CANVAS_NOTES) and field.endswith((".position", ".size")))


def _same(one: object, other: object) -> bool:
    if isinstance(one, _Absent) or isinstance(other, _Absent):
        return one is other
    return is_equal_data(one, other)


def _put(data: Plain, key: str, value: object, order: Plain) -> None:
    """Set or remove an entry; a new one goes after the one that it follows in `order`."""
    if isinstance(value, _Absent):
        data.pop(key, None)
        return
    if key in data:
        data[key] = value
        return
    names = list(order)
    before = next((name for name in reversed(names[: names.index(key)]) if name in data), None)
    entries = list(data.items())
    at = [name for name, _ in entries].index(before) + 1 if before is not None else len(entries)
    data.clear()
    data.update([*entries[:at], (key, value), *entries[at:]])


def _put_item(items: list[object], index: int, value: object) -> None:
    items[index] = value


def _is_replaced(base: object, now: object) -> bool:
    """Return whether a node is gone, new, or runs something else than before."""
    if not isinstance(base, dict) or not isinstance(now, dict):
        return True
    one, two = cast("Plain", base), cast("Plain", now)
    kind = kind_of(one, in_tree=True)
    if kind != kind_of(two, in_tree=True):
        return True
    runs = one.get(kind), two.get(kind)
    return any(isinstance(each, str) for each in runs) and runs[0] != runs[1]


def _with_renamed(base: Plain, mine: Plain, theirs: Plain) -> Plain:
    """Return the base with the names of the file, and give the file the names of who saves, for renamed nodes."""
    for old, new in _renamed(base, mine, theirs):
        entries = [(new if key == old else key, value) for key, value in theirs.items()]
        theirs.clear()
        theirs.update(entries)
        base = {new if key == old else key: value for key, value in base.items()}
    for old, new in _renamed(base, theirs, mine):
        base = {new if key == old else key: value for key, value in base.items()}
    return base


def _with_renamed_back(base: Plain, mine: Plain, theirs: Plain) -> Plain:
    """Return the data of who saves with the names that the file has given to nodes."""
    for old, new in _renamed(base, theirs, mine):
        mine = {new if key == old else key: value for key, value in mine.items()}
    return mine


def _renamed(base: Plain, renaming: Plain, other: Plain) -> Iterator[tuple[str, str]]:
    """Yield old and new names of the nodes that one side has renamed and left as they were otherwise."""
    fresh = [name for name in renaming if name not in base and name not in other]
    for old, value in base.items():
        if old in renaming or old not in other:
            continue
        new = next((name for name in fresh if _essence(renaming[name]) == _essence(value)), None)
        if new is not None:
            fresh.remove(new)
            yield old, new


def _essence(node: object) -> object:
    """Return a node without its targets, which follow renamed siblings."""
    if not isinstance(node, dict):
        return node
    return {key: value for key, value in cast("Plain", node).items() if key != "transitions"}


def _names(items: list[object]) -> list[str] | None:
    """Return the names of the nodes in a list; None if it is no list of nodes."""
    if not items or not all(isinstance(each, dict) and kind_of(cast("Plain", each), in_tree=True) for each in items):
        return None
    return tree_names([cast("Plain", each) for each in items])


def _changed_nodes(base: Outline, theirs: Outline) -> Iterator[str]:
    """Yield the nodes of the file that are new, or say something else; a container without its children."""
    for path, ref in theirs.refs.items():
        before = base.refs.get(path)
        if before is None or _own(before.data) != _own(ref.data):
            yield path


def _own(node: Plain) -> object:
    inside = {id(child) for _, _, child in child_entries(node)}
    return _without(node, inside)


def _without(value: object, inside: set[int]) -> object:
    if isinstance(value, dict):
        if id(cast("object", value)) in inside:
            return None
        return {key: _without(each, inside) for key, each in cast("Plain", value).items()}
    if isinstance(value, list):
        return [_without(each, inside) for each in cast("list[object]", value)]
    return value
