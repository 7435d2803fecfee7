"""The edits of a document: what can be asked for, as frozen messages with the word `edit` saying which."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

CanvasPoint = tuple[float, float]
NodePath = Annotated[str, Meta(max_length=4000, description="A node, `root/approach/left`")]
NodeName = Annotated[str, Meta(pattern="^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$", description="Letters, digits, `_` and `-`")]


class TransitionRef(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, rename={"source": "from"}):
    """An arrow of a machine: a child of it (its path), and one of its outcomes."""

    source: NodePath
    outcome: str


class Edit(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="edit"):
    """Root of the edits."""


class AddNode(Edit, frozen=True, kw_only=True, tag="add_node"):
    """Put a new node into a container; its name is made up where none is given.

    `kind` is a key of documents: state, behavior, machine, concurrency, priority, tree, foreach, and inside trees
    sequence, selector, inverter, and so on. `runs` is what a state, behavior or behaviour runs. With `yaml`, nodes
    as `copy` gives them, the content is that instead. `after` leads the open good outcomes of a
    sibling (its path) to the new node; `on_edge` puts it into an arrow. `index` is its place among the children.
    """

    parent: NodePath
    kind: str = ""
    runs: str = ""
    parameters: dict[str, object] = {}
    name: NodeName | None = None
    yaml: str = ""
    index: int | None = None
    position: CanvasPoint | None = None
    after: NodePath | None = None
    on_edge: TransitionRef | None = None


class RemoveNodes(Edit, frozen=True, kw_only=True, tag="remove_nodes"):
    """Take nodes out, with the transitions and conditions that name them; other references show as findings."""

    paths: tuple[NodePath, ...]


class RenameNode(Edit, frozen=True, kw_only=True, tag="rename_node"):
    """Give a node another name; whatever refers to it follows."""

    path: NodePath
    name: NodeName


class MoveNodes(Edit, frozen=True, kw_only=True, tag="move_nodes"):
    """Put nodes into another container, or elsewhere among their siblings; transitions among them stay."""

    paths: tuple[NodePath, ...]
    parent: NodePath
    index: int | None = None


class SetTransition(Edit, frozen=True, kw_only=True, tag="set_transition"):
    """Lead an outcome of a node to a sibling, or to an outcome of the machine around it."""

    path: NodePath
    outcome: str
    target: NodeName


class ClearTransition(Edit, frozen=True, kw_only=True, tag="clear_transition"):
    """Lead an outcome of a node nowhere."""

    path: NodePath
    outcome: str


class SetInitial(Edit, frozen=True, kw_only=True, tag="set_initial"):
    """Let a machine begin with a child."""

    path: NodePath
    child: NodeName


class SetParameter(Edit, frozen=True, kw_only=True, tag="set_parameter"):
    """Give a state or behavior a value for a parameter."""

    path: NodePath
    name: str
    value: object


class ClearParameter(Edit, frozen=True, kw_only=True, tag="clear_parameter"):
    """Take the value of a parameter back; its default holds."""

    path: NodePath
    name: str


class SetField(Edit, frozen=True, kw_only=True, tag="set_field"):
    """Set one thing of a node; null takes it away.

    For every node: description, timeout, retry, guard, on_error, autonomy, resume, in, out, success, every, post,
    notes, and what it runs (state, behavior, behaviour). For containers the keys of their kind: initial, conditions,
    otherwise, userdata, shared, items, times, as, index, next, collect, memory, policy, synchronise, success_count,
    failure_count, after, status, running, failure; and `order`, the names of all children in their new order.
    """

    path: NodePath
    field: str
    value: object = None


class SetPositions(Edit, frozen=True, kw_only=True, tag="set_positions"):
    """Place nodes on the canvas, in pixels relative to their container; null forgets a position."""

    positions: dict[NodePath, CanvasPoint | None]


class GroupNodes(Edit, frozen=True, kw_only=True, tag="group"):
    """Put siblings into a new container in their place; what leads out of them becomes its outcomes."""

    paths: tuple[NodePath, ...]
    kind: Literal["machine", "priority", "concurrency", "sequence", "selector", "parallel"]
    name: NodeName | None = None


class UngroupNode(Edit, frozen=True, kw_only=True, tag="ungroup"):
    """Put the children of a container in its place."""

    path: NodePath


class DuplicateNodes(Edit, frozen=True, kw_only=True, tag="duplicate"):
    """Put copies of nodes beside them; transitions among them lead to the copies."""

    paths: tuple[NodePath, ...]


class PasteNodes(Edit, frozen=True, kw_only=True, tag="paste"):
    """Put nodes as `copy` gives them into a container."""

    parent: NodePath
    yaml: str
    position: CanvasPoint | None = None
    index: int | None = None


class SetDocument(Edit, frozen=True, kw_only=True, tag="set_document"):
    """Change what the document declares; null takes a key away. The other keys stay.

    Keys: name, description, cell, parameters, userdata, outcomes, success.
    """

    changes: dict[str, object]


class AutoConnect(Edit, frozen=True, kw_only=True, tag="auto_connect"):
    """Lead the open outcomes of nodes where they obviously go; of all children for a machine."""

    paths: tuple[NodePath, ...]


AnyEdit = (
    AddNode
    | RemoveNodes
    | RenameNode
    | MoveNodes
    | SetTransition
    | ClearTransition
    | SetInitial
    | SetParameter
    | ClearParameter
    | SetField
    | SetPositions
    | GroupNodes
    | UngroupNode
    | DuplicateNodes
    | PasteNodes
    | SetDocument
    | AutoConnect
)
