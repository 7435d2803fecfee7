"""The shape of a node, whatever kinds there are: its kind, and the nodes that it holds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache, cached_property
from typing import Self, cast

from msgspec import Struct

from engine.document.decoding import StrictModel
from engine.document.decorator_spec import DecoratorSpec
from engine.document.node_kind import COMMON_KEYS, WRAPPERS, numbered

Keys = tuple[str | int, ...]


class NodeShape(StrictModel, frozen=True, kw_only=True, dict=True):
    """A node whose fields are the common ones and its kinds; what a kind holds follows from the keys in it."""

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """All kind keys of the node; a valid node has one."""
        plain = (key for key in kind_keys(type(self)) if getattr(self, key) is not None)
        return (*plain, *(key for key in WRAPPERS if getattr(getattr(self, key), "child", None) is not None))

    @property
    def kind(self) -> str:
        """The kind key of the node."""
        return self.kinds[0]

    @property
    def decorator(self) -> DecoratorSpec | None:
        """What it does to its only child; None for a node of another kind."""
        body: object = getattr(self, self.kind)
        return body if isinstance(body, DecoratorSpec) else None

    @property
    def own_name(self) -> str:
        """Its name inside a tree."""
        raise NotImplementedError

    @cached_property
    def children(self) -> Mapping[str, Self]:
        """The nodes directly inside, by the last part of their path, in document order."""
        return {name: child for name, (_, child) in self._placed.items()}

    def child_keys(self, name: str) -> Keys:
        """Return the keys, from this node inward, under which the child `name` is written."""
        return self._placed[name][0]

    @cached_property
    def _placed(self) -> Mapping[str, tuple[Keys, Self]]:
        kind = self.kinds[0] if self.kinds else ""
        written = [(keys, cast("Self", child)) for keys, child in _nodes_in((kind,), getattr(self, kind, None))]
        if written and written[0][0][1:2] == ("states",):
            names = [str(keys[-1]) for keys, _ in written]
        elif kind == "foreach":
            names = ["child"]
        else:
            names = numbered(child.own_name for _, child in written)
        return dict(zip(names, written, strict=True))


@cache
def kind_keys(model: type[NodeShape]) -> tuple[str, ...]:
    """Return the kinds of a model of nodes, in its order; policies that are decorators are not among them."""
    return tuple(key for key in model.__struct_fields__ if key not in COMMON_KEYS)


def _nodes_in(keys: Keys, body: object) -> Iterator[tuple[Keys, NodeShape]]:
    """Yield the nodes in the value of a key: a node, a list or mapping of nodes, or a model with such values."""
    if isinstance(body, NodeShape):
        yield keys, body
    elif isinstance(body, tuple):
        for index, each in enumerate(cast("tuple[object, ...]", body)):
            if isinstance(each, NodeShape):
                yield (*keys, index), each
    elif isinstance(body, dict):
        for name, each in cast("dict[str, object]", body).items():
            if isinstance(each, NodeShape):
                yield (*keys, name), each
    elif isinstance(body, Struct):
        for name, key in zip(body.__struct_fields__, body.__struct_encode_fields__, strict=True):
            yield from _nodes_in((*keys, key), getattr(body, name))
