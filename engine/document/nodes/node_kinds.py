"""The table of node kinds: what editor, catalogue and page know of each kind of node, declared once.

The model of a decorator declares it. Of the others only the texts are here: how each holds nodes and runs is its own.
Kinds that hold no nodes have an icon only.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Literal, get_args, get_origin

from msgspec import Struct
from msgspec.structs import fields

from engine.document.nodes.decorator_spec import DecoratorSpec
from engine.document.nodes.node_kind import KINDS, WRAPPERS, FormField
from engine.document.nodes.node_spec import (
    TREE_KINDS,
    ConcurrencySpec,
    ForEachSpec,
    MachineSpec,
    NodeSpec,
)
from engine.document.nodes.tree_composites import CompositeSpec, IfThenElseSpec, ParallelSpec, WhileDoElseSpec
from engine.state import State


@dataclass(frozen=True, kw_only=True)
class KindField:
    """A field in the form of a node; a switch is on where the document says nothing, a list may be written out."""

    key: str
    label: str
    hint: str
    control: Literal["list", "switch", "text"]


@dataclass(frozen=True, kw_only=True)
class NodeKind:
    """A kind of node that holds others; `new` is what a new one has under its key."""

    kind: str
    """Its key in documents."""
    title: str
    doc: str
    icon: str
    model: type[Struct] | None
    """The model of the mapping under its key; None where a node is under it."""
    new: object

    @property
    def only_in_tree(self) -> bool:
        """Whether it is a part of a tree."""
        return self.kind not in KINDS

    @property
    def is_decorator(self) -> bool:
        """Whether it is a part of a tree with one child."""
        return self.model is not None and issubclass(self.model, DecoratorSpec)

    def has(self, key: str) -> bool:
        """Return whether it has a key of its own."""
        return self.model is not None and key in self.model.__struct_encode_fields__

    @property
    def form(self) -> tuple[KindField, ...]:
        """The fields that forms show, in order."""
        return tuple(
            KindField(key=key, label=shown.label, hint=shown.hint, control=_control(kind))
            for key, kind, shown in (_form_fields(self.model) if self.model is not None else ())
            if shown.label
        )


def _control(kind: object) -> Literal["list", "switch", "text"]:
    if kind is bool:
        return "switch"
    return "list" if list[object] in get_args(kind) else "text"


def _form_fields(model: type[Struct]) -> Iterator[tuple[str, object, FormField]]:
    """Yield key, type and description of the fields that have one."""
    for field in fields(model):
        if get_origin(field.type) is Annotated:
            kind, *notes = get_args(field.type)
            yield from ((field.encode_name, kind, note) for note in notes if isinstance(note, FormField))


def _kind(key: str, title: str, doc: str, icon: str, model: type[Struct] | None, new: object) -> tuple[str, NodeKind]:
    return key, NodeKind(kind=key, title=title, doc=doc, icon=icon, model=model, new=new)


def _decorators() -> Iterator[tuple[str, NodeKind]]:
    for field in fields(NodeSpec):
        for model in get_args(field.type):
            if isinstance(model, type) and issubclass(model, DecoratorSpec):
                title = field.name.replace("_", " ").capitalize()
                new = {key: shown.new for key, _, shown in _form_fields(model) if shown.new is not None}
                yield _kind(field.name, title, model.doc, model.icon, model, new)


_KINDS = dict((
    _kind("machine", "State machine", "Executes one child at a time, from the initial one along the transitions.",
          "sitemap", MachineSpec, {"states": {}}),
    _kind("concurrency", "Concurrency",
          "Executes children concurrently; the first condition that is true decides the outcome.",
          "split", ConcurrencySpec, {"states": {}, "conditions": []}),
    _kind("priority", "Priority machine", "A state machine; while it is active, everything outside its path is paused.",
          "shuffle", MachineSpec, {"states": {}}),
    _kind("tree", "Behavior tree", "Ticks sequences, selectors and decorators; ends with success or failure.",
          "tree", None, {"sequence": []}),
    _kind("foreach", "For each", "Executes its child once for each item, or a number of times.",
          "list", ForEachSpec, {"times": 1}),
    _kind("sequence", "Sequence", "Executes children in order until one fails.", "arrow", CompositeSpec, []),
    _kind("selector", "Selector", "Executes children in order until one succeeds.", "question", CompositeSpec, []),
    _kind("parallel", "Parallel",
          "Executes children in parallel; the policy defines which successes are required.",
          "equal", ParallelSpec, []),
    _kind("if_then_else", "If, then, else",
          "Executes one child, then the second if it succeeded, else the third.", "fork", IfThenElseSpec, {}),
    _kind("while_do_else", "While, do, else",
          "Executes the second child while the first succeeds, the third while it fails.",
          "while", WhileDoElseSpec, {}),
    *_decorators(),
))  # fmt: skip
NODE_KINDS: Mapping[str, NodeKind] = {key: _KINDS[key] for key in (*KINDS, *TREE_KINDS, *WRAPPERS) if key in _KINDS}
"""The kinds that hold nodes, by key: those for machines first, then the parts of trees."""
LEAF_ICONS: Mapping[str, str] = {"state": "state", "behavior": "behavior", "behaviour": "state"}
"""The names of the icons of the kinds that hold no nodes; that of a state without one of its own."""


def node_icon(kind: str, state: type[State] | None = None) -> str:
    """Return the name of the icon of a node.

    Args:
        kind: Its key in documents; an unknown one has the icon of a state.
        state: The class that it runs, if it is a known state.
    """
    if state is not None:
        return state.icon or _group_icon(state.__module__) or LEAF_ICONS["state"]
    found = NODE_KINDS.get(kind)
    return found.icon if found is not None else LEAF_ICONS.get(kind, LEAF_ICONS["state"])


def _group_icon(module: str) -> str:
    """Return the icon that a module names for its states, or its package; empty without."""
    for name in (module, module.rpartition(".")[0]):
        icon = getattr(sys.modules.get(name), "ICON", "")
        if isinstance(icon, str) and icon:
            return icon
    return ""
