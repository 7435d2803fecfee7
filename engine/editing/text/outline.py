"""The nodes of a document as plain data, also of an incomplete or invalid document."""

from __future__ import annotations

from collections.abc import Iterator
from typing import cast

import msgspec

from engine.document.nodes.node_kind import GROUPS, KINDS, NAMED, SLOTS, WRAPPERS, derived_name, numbered
from engine.document.nodes.node_spec import TREE_KINDS
from engine.editing.text.draft import EditRefused
from engine.wording.suggestions import did_you_mean

Plain = dict[str, object]
_PLAIN_KINDS = (*KINDS, *TREE_KINDS)
Keys = tuple[str | int, ...]


class NodeRef(msgspec.Struct, frozen=True, eq=False, gc=False):
    """A node and its position: `keys` lead to it from the document, `parent` is the surrounding node."""

    path: str
    name: str
    kind: str
    data: Plain
    keys: Keys
    parent: NodeRef | None

    @property
    def in_tree(self) -> bool:
        """True for a node of a tree, inner node or leaf."""
        return self.parent is not None and (self.parent.kind == "tree" or self.parent.is_part)

    @property
    def is_part(self) -> bool:
        """True for a kind that is valid only inside a tree."""
        return self.kind in TREE_KINDS or self.kind in WRAPPERS

    @property
    def body(self) -> Plain:
        """The mapping under the key of its kind; empty if there is no mapping."""
        found = self.data.get(self.kind)
        return cast("Plain", found) if isinstance(found, dict) else {}

    @property
    def role(self) -> str:
        """Its key in the surrounding tree node, such as `then`; empty if children have no roles."""
        return str(self.keys[-1]) if self.parent is not None and self.parent.kind in SLOTS else ""

    @property
    def states(self) -> Plain:
        """The children of a container with named ones."""
        found = self.body.get("states")
        return cast("Plain", found) if isinstance(found, dict) else {}


class Outline:
    """All nodes of a document by path, in document order, containers before their children."""

    def __init__(self, document: Plain) -> None:
        self.refs: dict[str, NodeRef] = {}
        self._inside: dict[str, tuple[NodeRef, ...]] = {}
        root = document.get("root")
        if isinstance(root, dict):
            self._walk(cast("Plain", root))

    def at(self, path: str) -> NodeRef:
        """Return a node; raises EditRefused if there is no such node."""
        if path not in self.refs:
            raise EditRefused(f"there is no node `{path}`", hint=did_you_mean(path, self.refs))
        return self.refs[path]

    def children(self, ref: NodeRef) -> tuple[NodeRef, ...]:
        """Return the nodes directly inside one."""
        return self._inside.get(ref.path, ())

    def path_of(self, data: Plain) -> str:
        """Return the path of a node by its data."""
        return next(path for path, ref in self.refs.items() if ref.data is data)

    def _walk(self, root: Plain) -> None:
        refs = self.refs
        due = [NodeRef("root", "root", kind_of(root), root, ("root",), None)]
        while due:
            ref = due.pop()
            path, kind = ref.path, ref.kind
            refs[path] = ref
            if isinstance(ref.data.get(kind), str):
                continue
            in_tree, above = kind == "tree" or ref.is_part, ref.keys
            inside = self._inside[path] = tuple(
                [
                    NodeRef(f"{path}/{name}", name, kind_of(child, in_tree=in_tree), child, (*above, *keys), ref)
                    for name, keys, child in child_entries(ref.data)
                ]
            )
            due += inside[::-1]


def kind_of(node: Plain, *, in_tree: bool = False) -> str:
    """Return the key that defines the kind of a node; empty if there is none."""
    for kind in _PLAIN_KINDS:
        if kind in node:
            return kind
    wrapping = [key for key in WRAPPERS if isinstance(node.get(key), dict) and "child" in cast("Plain", node[key])]
    if not wrapping and in_tree:
        wrapping = [key for key in WRAPPERS if key in node]
    return wrapping[0] if wrapping else ""


def child_entries(node: Plain) -> list[tuple[str, Keys, Plain]]:
    """Return the children of a node: name, keys from the node inward, data."""
    kind = kind_of(node)
    body = node.get(kind)
    if kind in NAMED and isinstance(body, dict):
        states = cast("Plain", body).get("states")
        named = cast("Plain", states).items() if isinstance(states, dict) else ()
        return [(name, (kind, "states", name), cast("Plain", each)) for name, each in named if isinstance(each, dict)]
    if kind == "tree" and isinstance(body, dict):
        child = cast("Plain", body)
        return [(own_name(child), ("tree",), child)] if child else []
    if kind in GROUPS:
        keys: Keys = (kind,) if isinstance(body, list) else (kind, "children")
        listed = cast("object", cast("Plain", body).get("children") if isinstance(body, dict) else body)
        nodes = cast("list[object]", listed) if isinstance(listed, list) else []
        found = [(index, cast("Plain", each)) for index, each in enumerate(nodes) if isinstance(each, dict)]
        names = tree_names([each for _, each in found])
        return [(name, (*keys, index), each) for name, (index, each) in zip(names, found, strict=True)]
    if kind in SLOTS and isinstance(body, dict):
        filled = [
            (key, cast("Plain", each)) for key in SLOTS[kind] if isinstance(each := cast("Plain", body).get(key), dict)
        ]
        names = tree_names([each for _, each in filled])
        return [(name, (kind, key), each) for name, (key, each) in zip(names, filled, strict=True)]
    if kind and isinstance(body, dict) and isinstance(cast("Plain", body).get("child"), dict):
        child = cast("Plain", cast("Plain", body)["child"])
        return [("child" if kind == "foreach" else own_name(child), (kind, "child"), child)]
    return []


def own_name(node: Plain) -> str:
    """Return the name of a node inside a tree: as given, else derived from its kind."""
    given = node.get("name")
    if isinstance(given, str):
        return given
    runs = str(node.get("state") or node.get("behaviour") or "")
    reference = node.get("behavior")
    return derived_name(runs, reference if isinstance(reference, str) else "", kind_of(node, in_tree=True))


def tree_names(children: list[Plain]) -> list[str]:
    """Return names for the children of a composite; a name that is taken gets a number."""
    return numbered(map(own_name, children))


def transition_entries(node: Plain) -> Iterator[tuple[Plain, str, str]]:
    """Iterate over the targets of a node: the mapping that contains it, the key in it, the target."""
    transitions = node.get("transitions")
    if isinstance(transitions, dict):
        for outcome, target in list(cast("Plain", transitions).items()):
            if isinstance(target, str):
                yield cast("Plain", transitions), outcome, target
    if "timeout" not in node and "guard" not in node and "on_error" not in node:
        return
    for key in ("timeout", "guard"):
        measure = node.get(key)
        if isinstance(measure, dict) and isinstance(cast("Plain", measure).get("to"), str):
            yield cast("Plain", measure), "to", str(cast("Plain", measure)["to"])
    if isinstance(node.get("on_error"), str):
        yield node, "on_error", str(node["on_error"])


def targets_of(node: Plain) -> list[str]:
    """Return the targets of a node, as `transition_entries` has them."""
    if "timeout" in node or "guard" in node or "on_error" in node:
        return [target for _, _, target in transition_entries(node)]
    transitions = node.get("transitions")
    values = cast("Plain", transitions).values() if isinstance(transitions, dict) else ()
    return [target for target in values if isinstance(target, str)]
