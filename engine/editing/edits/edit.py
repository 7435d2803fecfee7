"""The edits of a document, as frozen messages with the tag `edit`."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from engine.document.canvas_note import CanvasNote, NoteName

CanvasPoint = tuple[float, float]
NodePath = Annotated[str, Meta(max_length=4000, description="Path of a node, `root/approach/left`")]
NodeName = Annotated[str, Meta(pattern="^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$", description="Letters, digits, `_` and `-`")]


class TransitionRef(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, rename={"source": "from"}):
    """A transition of a machine: a child (its path), and one of its outcomes."""

    source: NodePath
    outcome: str


class Edit(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="edit"):
    """Base class of the edits."""


class AddNode(Edit, frozen=True, kw_only=True, tag="add_node"):
    """Insert a new node into a container; its name is generated if none is given.

    `kind` is a key of documents: state, behavior, machine, concurrency, priority, tree, foreach, and inside trees
    sequence, selector, and so on. `runs` is what a state, behavior or behaviour runs. With `yaml`, nodes
    as `copy` returns them are the content instead. `after` connects the open success outcomes of a
    sibling (its path) to the new node; `on_edge` inserts it into a transition. `index` is its position among the
    children.
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
    """Remove nodes, with the transitions and conditions that name them; other references become findings."""

    paths: tuple[NodePath, ...]


class RenameNode(Edit, frozen=True, kw_only=True, tag="rename_node"):
    """Rename a node; all references to it are updated."""

    path: NodePath
    name: NodeName


class MoveNodes(Edit, frozen=True, kw_only=True, tag="move_nodes"):
    """Move nodes to another container, or to another position among their siblings; transitions among them are kept."""

    paths: tuple[NodePath, ...]
    parent: NodePath
    index: int | None = None


class SetTransition(Edit, frozen=True, kw_only=True, tag="set_transition"):
    """Connect an outcome of a node to a sibling, or to an outcome of the surrounding machine."""

    path: NodePath
    outcome: str
    target: NodeName


class ClearTransition(Edit, frozen=True, kw_only=True, tag="clear_transition"):
    """Remove the transition of an outcome of a node."""

    path: NodePath
    outcome: str


class SetInitial(Edit, frozen=True, kw_only=True, tag="set_initial"):
    """Set the initial child of a machine."""

    path: NodePath
    child: NodeName


class SetParameter(Edit, frozen=True, kw_only=True, tag="set_parameter"):
    """Set a parameter of a state or behavior."""

    path: NodePath
    name: str
    value: object


class ClearParameter(Edit, frozen=True, kw_only=True, tag="clear_parameter"):
    """Remove the value of a parameter; its default applies."""

    path: NodePath
    name: str


class SetField(Edit, frozen=True, kw_only=True, tag="set_field"):
    """Set one field of a node; null removes it.

    For every node: description, timeout, retry, guard, on_error, autonomy, resume, in, out, success, every, post,
    disabled, notes, and what it runs (state, behavior, behaviour). For containers the keys of their kind: initial,
    conditions, otherwise, userdata, shared, items, times, as, index, next, collect, memory, policy, synchronise,
    success_count, failure_count, after, status, running, failure; and `order`, the names of all children in their new
    order.
    """

    path: NodePath
    field: str
    value: object = None


class SetPositions(Edit, frozen=True, kw_only=True, tag="set_positions"):
    """Set the canvas positions of nodes, in pixels relative to their container; null removes a position."""

    positions: dict[NodePath, CanvasPoint | None]


class SetCanvasNote(Edit, frozen=True, kw_only=True, tag="set_canvas_note"):
    """Add a free note to the canvas of a container, change it, move it, resize it; null removes it."""

    path: NodePath
    name: NoteName
    note: CanvasNote | None


class GroupNodes(Edit, frozen=True, kw_only=True, tag="group"):
    """Group siblings in a new container in their place; transitions that leave them become its outcomes."""

    paths: tuple[NodePath, ...]
    kind: Literal["machine", "priority", "concurrency", "sequence", "selector", "parallel"]
    name: NodeName | None = None


class UngroupNode(Edit, frozen=True, kw_only=True, tag="ungroup"):
    """Replace a container with its children."""

    path: NodePath


class TypeLoss(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What another type of a node cannot keep: where it is, what it is, its value as JSON, and why it does not fit."""

    path: NodePath
    item: str
    value: str
    reason: str


class ReplaceType(Edit, frozen=True, kw_only=True, tag="replace_type"):
    """Give nodes another type in place; what fits is kept.

    `kind` is state, behavior, or that of a container or part of a tree; `runs` is what a state or behavior runs.
    What does not fit is removed, but only if it is in `accepted`; otherwise the edit is refused with all `losses`.
    """

    paths: tuple[NodePath, ...]
    kind: str
    runs: str = ""
    accepted: Annotated[tuple[TypeLoss, ...], Meta(max_length=10_000)] = ()


class DuplicateNodes(Edit, frozen=True, kw_only=True, tag="duplicate"):
    """Insert copies of nodes next to them; transitions among them connect the copies."""

    paths: tuple[NodePath, ...]


class PasteNodes(Edit, frozen=True, kw_only=True, tag="paste"):
    """Insert nodes, in the form that `copy` returns, into a container."""

    parent: NodePath
    yaml: str
    position: CanvasPoint | None = None
    index: int | None = None


class SetDocument(Edit, frozen=True, kw_only=True, tag="set_document"):
    """Change declarations of the document; null removes a key. Other keys are unchanged.

    Keys: name, description, cell, parameters, userdata, outcomes, success.
    """

    changes: dict[str, object]


class AutoConnect(Edit, frozen=True, kw_only=True, tag="auto_connect"):
    """Connect the open outcomes of nodes to their evident targets; for a machine, those of all children."""

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
    | SetCanvasNote
    | GroupNodes
    | UngroupNode
    | ReplaceType
    | DuplicateNodes
    | PasteNodes
    | SetDocument
    | AutoConnect
)
