"""The shape of a node, whatever kinds there are: its kind, and the nodes that it holds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, cached_property
from typing import Self, TypeVar, cast

from msgspec import Struct

from engine.document.nodes.decorator_spec import DecoratorSpec
from engine.document.nodes.node_kind import COMMON_KEYS, NAMED, WRAPPERS, numbered
from engine.document.text.decoding import StrictModel

T = TypeVar("T")
Keys = tuple[str | int, ...]
_STATE = "state"
"""The kind of most nodes, which is found without a look at the others."""


class NodeShape(StrictModel, frozen=True, kw_only=True, dict=True):
    """A node whose fields are the common ones and its kinds; what a kind holds follows from the keys in it."""

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """All kind keys of the node; a valid node has one."""
        plain = [key for key in kind_keys(type(self)) if getattr(self, key) is not None]
        return (*plain, *[key for key in WRAPPERS if getattr(getattr(self, key), "child", None) is not None])

    @property
    def kind(self) -> str:
        """The kind key of the node."""
        return _STATE if getattr(self, _STATE) is not None else self.kinds[0]

    @property
    def decorator(self) -> DecoratorSpec | None:
        """What it does to its only child; None for a node of another kind."""
        body: object = getattr(self, self.kind)
        return body if isinstance(body, DecoratorSpec) else None

    @property
    def own_name(self) -> str:
        """Its name inside a tree."""
        raise NotImplementedError

    @property
    def children(self) -> Mapping[str, Self]:
        """The nodes directly inside, by the last part of their path, in document order."""
        return {} if getattr(self, _STATE) is not None else self._inside

    def child_keys(self, name: str) -> Keys:
        """Return the keys, from this node inward, under which the child `name` is written."""
        return self._keys_inside[name]

    @cached_property
    def clear_of(self) -> set[object]:
        """The checks that found nothing in this node and depend on nothing around it; they note it here."""
        return set()

    def derived(self, derive: Callable[[Self], T]) -> T:
        """Return what a function derives from this node alone; it is called once, whoever asks."""
        if derive not in self._derived:
            self._derived[derive] = derive(self)
        return cast("T", self._derived[derive])

    @cached_property
    def _derived(self) -> dict[object, object]:
        return {}

    @property
    def nodes_as_root(self) -> tuple[tuple[str, Self], ...]:
        """The nodes of a document whose root it is, with their paths, outer ones first."""
        return (("root", self), *self._below_root)

    # Without the node itself: it would stay in memory until the collector comes by.
    @cached_property
    def _below_root(self) -> tuple[tuple[str, Self], ...]:
        found: list[tuple[str, Self]] = []
        due = [(f"root/{name}", child) for name, child in reversed(list(self.children.items()))]
        while due:
            path, node = due.pop()
            found.append((path, node))
            if inside := node.children:
                due += [(f"{path}/{name}", child) for name, child in reversed(list(inside.items()))]
        return tuple(found)

    @cached_property
    def _inside(self) -> Mapping[str, Self]:
        return {name: child for name, _, child in self._placed()}

    @cached_property
    def _keys_inside(self) -> Mapping[str, Keys]:
        return {name: keys for name, keys, _ in self._placed()}

    def _placed(self) -> list[tuple[str, Keys, Self]]:
        if not self.kinds:
            return []
        kind = self.kind
        written = [(keys, cast("Self", node)) for keys, node in _nodes_in(kind, getattr(self, kind))]
        if kind in NAMED:
            return [(str(keys[-1]), keys, node) for keys, node in written]
        if kind == "foreach":
            return [("child", keys, node) for keys, node in written]
        names = numbered(node.own_name for _, node in written)
        return [(name, keys, node) for name, (keys, node) in zip(names, written, strict=True)]


@cache
def kind_keys(model: type[NodeShape]) -> tuple[str, ...]:
    """Return the kinds of a model of nodes, in its order; policies that are decorators are not among them."""
    return tuple(key for key in model.__struct_fields__ if key not in COMMON_KEYS)


def _nodes_in(kind: str, body: object) -> Iterator[tuple[Keys, NodeShape]]:
    """Yield the nodes under the key of a kind: a node, a list of nodes, or those in a model with keys of its own."""
    yield from _nodes_at((kind,), body)
    if isinstance(body, Struct) and not isinstance(body, NodeShape):
        for name, key in zip(body.__struct_fields__, body.__struct_encode_fields__, strict=True):
            yield from _nodes_at((kind, key), getattr(body, name))


def _nodes_at(keys: Keys, value: object) -> Iterator[tuple[Keys, NodeShape]]:
    entries: Iterable[tuple[str | int, object]] = ()
    if isinstance(value, NodeShape):
        yield keys, value
    elif isinstance(value, tuple):
        entries = enumerate(cast("tuple[object, ...]", value))
    elif isinstance(value, dict):
        entries = cast("dict[str, object]", value).items()
    for place, each in entries:
        if isinstance(each, NodeShape):
            yield (*keys, place), each
