"""Rules of a behavior document that types alone cannot say; the first breach is an error with its position."""

from __future__ import annotations

from collections.abc import Iterable

from engine.document.behavior import KINDS, Behavior, Node
from engine.document.expression import RESERVED
from engine.errors import DocumentError

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
    for path, node in behavior.nodes():
        _require_one_kind(behavior, path, node)
        if node.children:
            _require_container_keys(behavior, path, node)
        if node.concurrency is not None:
            _require_no_transitions(behavior, path, node)


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
        for index, name in enumerate(names):
            if name in names[:index]:
                where = behavior.source.position((key, index))
                raise DocumentError(f"`{name}` is repeated in `{key}`", where=where, hint="remove it")


def _require_one_kind(behavior: Behavior, path: str, node: Node) -> None:
    kinds = [kind for kind in KINDS if getattr(node, kind) is not None]
    if len(kinds) == 1:
        return
    if not kinds:
        where = behavior.key_position(path)
        raise DocumentError("this node has no kind", where=where, hint=f"add one of {_list(KINDS)}")
    where = behavior.key_position(path, kinds[1])
    raise DocumentError(f"this node is {_list(kinds)} at once", where=where, hint="keep one of them")


def _require_container_keys(behavior: Behavior, path: str, node: Node) -> None:
    for key, value in (("with", node.parameters), ("in", node.inputs), ("out", node.outputs)):
        if value:
            where = behavior.key_position(path, key)
            raise DocumentError(f"a {node.kind} container has no `{key}`", where=where, hint=_CONTAINER_KEYS[key])


def _require_no_transitions(behavior: Behavior, path: str, node: Node) -> None:
    for name, child in node.children.items():
        if child.transitions:
            where = behavior.key_position(f"{path}/{name}", "transitions")
            hint = "its outcomes are used in `conditions`"
            raise DocumentError(
                f"`{name}` runs side by side with others and has no transitions", where=where, hint=hint
            )


def _list(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)
