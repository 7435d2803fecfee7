"""Random edits: such that a model knows the meaning of, and such of every kind, sensible or not."""

from __future__ import annotations

from typing import Any, get_args, get_type_hints

import msgspec
from hypothesis import strategies as st

from engine.document.nodes import node_spec
from engine.document.nodes.node_kind import KINDS, WRAPPERS
from engine.document.nodes.node_spec import TREE_KINDS
from engine.editing.edits.edit import AnyEdit, GroupNodes
from engine.editing.text.outline import NodeRef, Outline
from tests.engine.editing.layouts import Plain

MACHINES = ("machine", "priority")
NAMED = (*MACHINES, "concurrency")
VALUES = (1, 2.5, "word", "${k}", [1, "a"], {"deep": {"er": None}}, True)
DESCRIPTIONS = ("One.", "a: b # c", "two\nlines", "  x ")


@st.composite
def simple_edits(draw: st.DrawFn, data: Plain) -> Plain | None:
    """Draw one of the edits that `model_of` knows; None where there is nothing to edit."""
    outline = Outline(data)
    refs = list(outline.refs.values())
    kind = draw(st.sampled_from(["rename", "remove", "wire", "unwire", "initial", "give", "describe"]))
    if kind in ("rename", "remove"):
        ref = _one(draw, [s for s in refs if s.parent is not None and s.parent.kind in NAMED])
        if ref is None or ref.parent is None or "other" in ref.parent.states:
            return None
        named = {"edit": "rename_node", "path": ref.path, "name": "other"}
        return named if kind == "rename" else {"edit": "remove_nodes", "paths": [ref.path]}
    if kind in ("wire", "unwire"):
        ref = _one(draw, [s for s in refs if s.parent is not None and s.parent.kind in MACHINES])
        return None if ref is None else _transition_edit(draw, ref, clear=kind == "unwire")
    if kind == "initial":
        ref = _one(draw, [s for s in refs if s.kind in MACHINES and outline.children(s)])
        if ref is None:
            return None
        return {"edit": "set_initial", "path": ref.path, "child": draw(st.sampled_from(list(ref.states)))}
    ref = _one(draw, [s for s in refs if "state" in s.data])
    if ref is None:
        return None
    if kind == "give":
        name = draw(st.sampled_from(["value", "text", "fresh"]))
        return {"edit": "set_parameter", "path": ref.path, "name": name, "value": draw(st.sampled_from(VALUES))}
    said = draw(st.sampled_from(DESCRIPTIONS))
    return {"edit": "set_field", "path": ref.path, "field": "description", "value": said}


def _transition_edit(draw: st.DrawFn, ref: NodeRef, *, clear: bool) -> Plain | None:
    wired: Any = ref.data.get("transitions", {})
    if not clear:
        target = draw(st.sampled_from(["x", "y", "s0"]))
        return {"edit": "set_transition", "path": ref.path, "outcome": "done", "target": target}
    if not wired:
        return None
    return {"edit": "clear_transition", "path": ref.path, "outcome": draw(st.sampled_from(sorted(wired)))}


def _one(draw: st.DrawFn, refs: list[NodeRef]) -> NodeRef | None:
    return draw(st.sampled_from(refs)) if refs else None


_NAMES = st.sampled_from(["fresh", "s0", "s1", "x", "b0", "child", "a b", ""])
_KINDS = st.sampled_from([*KINDS, *TREE_KINDS, *WRAPPERS, "zzz"])
_ODD = st.sampled_from(
    [None, 1, 0.5, "text", "${k}", [], ["s0"], {}, {"after": 1, "to": "x"}, {"a": "b"}, [{"x": {"b0": "a"}}]]
)
_NOTES = st.fixed_dictionaries(
    {
        "text": st.sampled_from(["", "plain", "two\nlines", "a: b # c"]),
        "position": st.tuples(st.floats(-99, 99), st.just(2)).map(list),
        "size": st.just([200, 90]),
        "colour": st.sampled_from(["yellow", "pink"]),
    }
)
_OF_NODES = sorted(
    each.encode_name
    for kind in vars(node_spec).values()
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct)
    for each in msgspec.structs.fields(kind)
)
_FIELDS = st.sampled_from([*dict.fromkeys(_OF_NODES), "order", "colour"])
_GROUPS = st.sampled_from(get_args(get_type_hints(GroupNodes)["kind"]))
_CLIPBOARDS = st.sampled_from(["a: {state: data.Put}", "x: 1", ": :", "a: {tree: {sequence: [{state: data.Put}]}}"])
_KEYS = st.sampled_from(["name", "outcomes", "userdata", "cell", "root"])


def any_edits(paths: list[str]) -> st.SearchStrategy[Plain]:
    """Draw an edit of any kind, sensible or not."""
    path = st.sampled_from([*paths, "root/nobody", ""])
    some = st.lists(path, max_size=3)
    index = st.none() | st.integers(-1, 5)
    point = st.none() | st.tuples(st.integers(-9, 900), st.floats())
    runs = st.sampled_from(["data.Put", "gone.yaml", ""])
    fields: dict[str, dict[str, st.SearchStrategy[Any]]] = {
        "add_node": {
            "parent": path, "kind": _KINDS, "runs": runs, "index": index, "position": point, "name": st.none() | _NAMES
        },
        "remove_nodes": {"paths": some},
        "rename_node": {"path": path, "name": _NAMES},
        "move_nodes": {"paths": some, "parent": path, "index": index},
        "set_transition": {"path": path, "outcome": _NAMES, "target": _NAMES},
        "clear_transition": {"path": path, "outcome": _NAMES},
        "set_initial": {"path": path, "child": _NAMES},
        "set_parameter": {"path": path, "name": _NAMES, "value": _ODD},
        "clear_parameter": {"path": path, "name": _NAMES},
        "set_field": {"path": path, "field": _FIELDS, "value": _ODD},
        "set_positions": {"positions": st.dictionaries(path, point, max_size=3)},
        "set_canvas_note": {"path": path, "name": _NAMES, "note": st.none() | _NOTES},
        "group": {"paths": some, "kind": _GROUPS},
        "ungroup": {"path": path},
        "replace_type": {"paths": some, "kind": _KINDS, "runs": runs},
        "duplicate": {"paths": some},
        "paste": {"parent": path, "yaml": _CLIPBOARDS},
        "auto_connect": {"paths": some},
        "set_document": {"changes": st.dictionaries(_KEYS, _ODD, max_size=2)},
    }  # fmt: skip
    tags = [str(kind.__struct_config__.tag) for kind in get_args(AnyEdit)]
    return st.one_of([st.fixed_dictionaries({"edit": st.just(tag), **fields[tag]}) for tag in tags])
