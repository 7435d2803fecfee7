"""Rules of a behavior document that types alone cannot say; the first breach is an error with its position."""

from __future__ import annotations

from collections.abc import Iterable

from engine.document.behavior import Behavior
from engine.document.cel_expression import RESERVED
from engine.document.node import KINDS, TREE_KINDS, TREE_OUTCOMES, WRAPPERS, Node, Parallel
from engine.errors import DocumentError
from engine.nearness import near_names

_CONTAINER_KEYS = {
    "with": "parameters go to states and behavior references",
    "in": "the children of a container read the keys around it directly",
    "out": "the children of a container write the keys around it directly",
}


def require_structure(behavior: Behavior) -> None:
    """Check kinds, places of keys and names.

    Raises:
        DocumentError: the first breach; `where` is its position.
    """
    _require_names(behavior)
    if behavior.root.transitions:
        where = behavior.key_position("root", "transitions")
        raise DocumentError("the root has no transitions", where=where, hint="its outcomes are those of the behavior")
    in_tree: dict[str, bool] = {"": False}
    for path, node in behavior.nodes():
        parent = path.rpartition("/")[0]
        _require_one_kind(behavior, path, node)
        if node.children:
            _require_container_keys(behavior, path, node)
        if node.concurrency is not None or node.foreach is not None:
            _require_no_transitions(behavior, path, node)
        if in_tree[parent]:
            _require_tree_part(behavior, path, node)
        else:
            _require_no_tree_part(behavior, path, node)
        # Inside a machine that is a leaf of a tree, machine rules hold again.
        in_tree[path] = node.tree is not None or (in_tree[parent] and node.kind in (*TREE_KINDS, *WRAPPERS))
        _require_rounds(behavior, path, node)
        _require_every(behavior, path, node)


def _require_every(behavior: Behavior, path: str, node: Node) -> None:
    if node.every is not None and node.behaviour is None:
        where = behavior.key_position(path, "every")
        raise DocumentError("`every` goes with a `behaviour`", where=where, hint="only that is ticked without an event")


def _require_names(behavior: Behavior) -> None:
    document = behavior.document
    for key in ("parameters", "userdata"):
        for name in getattr(document, key):
            if name in RESERVED:
                where = behavior.source.position((key, name), of_key=True)
                raise DocumentError(f"`{name}` is a word of the expression language", where=where, hint="rename it")
    for name in document.userdata:
        if name in document.parameters:
            where = behavior.source.position(("userdata", name), of_key=True)
            raise DocumentError(f"`{name}` is a parameter and a userdata key", where=where, hint="rename one of them")
    for key in ("outcomes", "success"):
        names: tuple[str, ...] = getattr(document, key)
        known: set[str] = set()
        for index, name in enumerate(names):
            if name in known:
                where = behavior.source.position((key, index))
                raise DocumentError(f"`{name}` is repeated in `{key}`", where=where, hint="remove it")
            known.add(name)


def _require_one_kind(behavior: Behavior, path: str, node: Node) -> None:
    kinds = node.kinds
    if len(kinds) == 1:
        return
    if not kinds:
        where = behavior.key_position(path)
        raise DocumentError("this node has no kind", where=where, hint=f"add one of {_list(KINDS)}")
    where = behavior.key_position(path, kinds[1])
    raise DocumentError(f"this node is {_list(kinds)} at once", where=where, hint="keep one of them")


def _require_tree_part(behavior: Behavior, path: str, node: Node) -> None:
    """Inside a tree nothing has transitions, and a target is a status."""
    for key in ("transitions", "autonomy"):
        if getattr(node, key) and (key == "transitions" or node.kind in TREE_KINDS):
            where = behavior.key_position(path, key)
            raise DocumentError(f"a part of a tree has no `{key}`", where=where, hint="trees know success and failure")
    for key in WRAPPERS[1:]:
        wrapper = getattr(node, key)
        if wrapper is None:
            continue
        if wrapper.child is not None and wrapper.to is not None:
            where = behavior.key_position(path, key, "to")
            raise DocumentError(f"`{key}` with a `child` has no `to`", where=where, hint="it fails; remove `to`")
        if wrapper.child is None and wrapper.to not in TREE_OUTCOMES:
            where = behavior.position(path, key)
            hint = f"add `to: failure`, or give it a `child` to make it a decorator; it may be {_list(TREE_OUTCOMES)}"
            raise DocumentError(f"`{key}` inside a tree needs a `to` that is a status", where=where, hint=hint)
    if node.on_error is not None and node.on_error not in TREE_OUTCOMES:
        where = behavior.position(path, "on_error")
        raise DocumentError(
            f"inside a tree there is no `{node.on_error}` to go to", where=where, hint=f"use {_list(TREE_OUTCOMES)}"
        )
    if node.kind in (*TREE_KINDS, *WRAPPERS):
        _require_bare(behavior, path, node)
    _require_policy(behavior, path, node)


def _require_policy(behavior: Behavior, path: str, node: Node) -> None:
    """A policy of a parallel names its children."""
    policy = node.parallel.policy if isinstance(node.parallel, Parallel) else ()
    for index, name in enumerate(() if isinstance(policy, str) else policy):
        if name not in node.children:
            where = behavior.position(path, "parallel", "policy", index)
            raise DocumentError(f"there is no child `{name}` here", where=where, hint=near_names(name, node.children))


def _require_bare(behavior: Behavior, path: str, node: Node) -> None:
    """A composite or decorator has nothing beside its kind."""
    for key in (*WRAPPERS, "on_error", "resume", "success"):
        if key != node.kind and getattr(node, key):
            where = behavior.key_position(path, key)
            hint = f"wrap it: `{key}: {{…, child: …}}`" if key in WRAPPERS else "remove it"
            raise DocumentError(f"a `{node.kind}` of a tree has no `{key}`", where=where, hint=hint)
    if node.kind == "retry" and node.retry is not None and node.retry.outcomes:
        where = behavior.key_position(path, "retry", "outcomes")
        hint = "it tries again after FAILURE"
        raise DocumentError("`retry` with a `child` has no `outcomes`", where=where, hint=hint)


def _require_no_tree_part(behavior: Behavior, path: str, node: Node) -> None:
    if node.kind in (*TREE_KINDS, *WRAPPERS):
        where = behavior.key_position(path, node.kind)
        hint = f"put it inside `tree:`, or use one of {_list(KINDS)}"
        raise DocumentError(f"`{node.kind}` stands only inside a tree", where=where, hint=hint)
    for key in ("name", "success"):
        if getattr(node, key):
            where = behavior.key_position(path, key)
            raise DocumentError(f"`{key}` of a node stands only inside a tree", where=where, hint="remove it")
    for key in WRAPPERS[1:]:
        wrapper = getattr(node, key)
        if wrapper is not None and wrapper.to is None:
            where = behavior.position(path, key)
            raise DocumentError("the key `to` is missing", where=where, hint=f"say where `{key}` leads")


def _require_rounds(behavior: Behavior, path: str, node: Node) -> None:
    rounds = node.foreach
    if rounds is not None and (rounds.items is None) == (rounds.times is None):
        where = behavior.key_position(path, "foreach")
        raise DocumentError("a foreach has either `items` or `times`", where=where, hint="give one of them")


def _require_container_keys(behavior: Behavior, path: str, node: Node) -> None:
    for key, value in (("with", node.parameters), ("in", node.inputs), ("out", node.outputs)):
        if value:
            where = behavior.key_position(path, key)
            raise DocumentError(f"a {node.kind} container has no `{key}`", where=where, hint=_CONTAINER_KEYS[key])


def _require_no_transitions(behavior: Behavior, path: str, node: Node) -> None:
    for name, child in node.children.items():
        if child.transitions:
            where = behavior.key_position(f"{path}/{name}", "transitions")
            rounds = node.foreach is not None
            hint = "its outcomes are used in `next`" if rounds else "its outcomes are used in `conditions`"
            beside = "is run round after round" if rounds else "runs side by side with others"
            raise DocumentError(f"`{name}` {beside} and has no transitions", where=where, hint=hint)


def _list(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)
